#pragma once

#include <tuple>
#include <utility>
#include <vector>

#include "framework/experiment/model/elements/contact_elements.hpp"
#include "framework/experiment/model/elements/coordinate_elements.hpp"
#include "framework/experiment/model/elements/element_lists.hpp"
#include "framework/experiment/model/elements/load_elements.hpp"
#include "framework/experiment/model/elements/memory_elements.hpp"
#include "framework/experiment/model/elements/two_point_elements.hpp"

namespace twinmap {

/// Lists of elements over a scalar S.
template <class S, template <class> class... Element>
struct ListsOf {
  std::tuple<std::vector<Element<S>>...> lists;

  template <class Action>
  static void forEachType(Action& action) {
    (action(ElementType<Element>{}), ...);
  }
};

/// All force elements, in the order of their keys in the file: the only place that lists them.
template <class S>
struct ForceElements<S>::Lists : ListsOf<S,               //
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
                                         Backlash> {};

template <class S>
ForceElements<S>::ForceElements() : lists_(std::make_unique<Lists>()) {}
template <class S>
ForceElements<S>::ForceElements(const ForceElements& other)
    : lists_(std::make_unique<Lists>(*other.lists_)) {}
template <class S>
ForceElements<S>::ForceElements(ForceElements&& other) noexcept = default;
template <class S>
ForceElements<S>& ForceElements<S>::operator=(const ForceElements& other) {
  return *this = ForceElements(other);
}
template <class S>
ForceElements<S>& ForceElements<S>::operator=(ForceElements&& other) noexcept = default;
template <class S>
ForceElements<S>::~ForceElements() = default;

template <class S>
template <template <class> class One>
std::vector<One<S>>& ForceElements<S>::get() {
  return std::get<std::vector<One<S>>>(lists_->lists);
}
template <class S>
template <template <class> class One>
const std::vector<One<S>>& ForceElements<S>::get() const {
  return std::get<std::vector<One<S>>>(lists_->lists);
}

template <class S>
template <class Type>
std::vector<typename Type::template Of<S>>& ForceElements<S>::getList(Type) {
  return get<Type::template Of>();
}
template <class S>
template <class Type>
const std::vector<typename Type::template Of<S>>& ForceElements<S>::getList(Type) const {
  return get<Type::template Of>();
}

template <class S>
template <class Action>
void ForceElements<S>::forEachType(Action action) {
  Lists::forEachType(action);
}
template <class S>
template <class Action>
void ForceElements<S>::forEachList(Action action) {
  std::apply([&](auto&... list) { (action(list), ...); }, lists_->lists);
}
template <class S>
template <class Action>
void ForceElements<S>::forEachList(Action action) const {
  std::apply([&](const auto&... list) { (action(list), ...); }, std::as_const(lists_->lists));
}

template <class Fields>
void describeElements(Fields& f, ForceElements<Expression>& elements) {
  elements.forEachList([&f](auto& list) {
    constexpr ElementKind kKind = std::decay_t<decltype(list)>::value_type::kKind;
    f.optional(kKind.key, list, kKind.what);
  });
}

}  // namespace twinmap
