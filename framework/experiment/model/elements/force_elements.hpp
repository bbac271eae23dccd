#pragma once

#include <tuple>
#include <vector>

#include "framework/experiment/model/elements/contact_elements.hpp"
#include "framework/experiment/model/elements/coordinate_elements.hpp"
#include "framework/experiment/model/elements/load_elements.hpp"
#include "framework/experiment/model/elements/memory_elements.hpp"
#include "framework/experiment/model/elements/two_point_elements.hpp"

namespace twinmap {

/// Stands for an element whatever its scalar.
template <template <class> class Element>
struct ElementType {
  template <class S>
  using Of = Element<S>;
};

/// A list of each kind of element over a scalar S.
template <class S, template <class> class... Element>
class ElementLists {
 public:
  template <template <class> class One>
  std::vector<One<S>>& get() {
    return std::get<std::vector<One<S>>>(lists_);
  }
  template <template <class> class One>
  const std::vector<One<S>>& get() const {
    return std::get<std::vector<One<S>>>(lists_);
  }

  template <class Type>
  auto& getList(Type) {
    return get<Type::template Of>();
  }
  template <class Type>
  const auto& getList(Type) const {
    return get<Type::template Of>();
  }

  /// action(ElementType) of each kind, in the order of the file's keys.
  template <class Action>
  static void forEachType(Action action) {
    (action(ElementType<Element>{}), ...);
  }
  /// action(list) of each kind.
  template <class Action>
  void forEachList(Action action) {
    std::apply([&](auto&... list) { (action(list), ...); }, lists_);
  }
  template <class Action>
  void forEachList(Action action) const {
    std::apply([&](const auto&... list) { (action(list), ...); }, lists_);
  }

 private:
  std::tuple<std::vector<Element<S>>...> lists_;
};

/// All force elements, in the order of their keys in the file: the only place that lists them.
template <class S>
using ForceElements = ElementLists<S,               //
                                   Spring,          //
                                   Damper,          //
                                   TwoPointSpring,  //
                                   TwoPointDamper,  //
                                   Bushing,         //
                                   AppliedForce,    //
                                   AppliedMoment,   //
                                   ForceLaw,        //
                                   Friction,        //
                                   Hysteresis,      //
                                   Contact,         //
                                   Stop,            //
                                   Backlash>;

template <class Fields>
void describeElements(Fields& f, ForceElements<Expression>& elements) {
  elements.forEachList([&f](auto& list) {
    constexpr ElementKind kKind = std::decay_t<decltype(list)>::value_type::kKind;
    f.optional(kKind.key, list, kKind.what);
  });
}

}  // namespace twinmap
