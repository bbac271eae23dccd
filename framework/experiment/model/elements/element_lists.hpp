#pragma once

#include <memory>
#include <vector>

namespace twinmap {

/// Stands for an element whatever its scalar.
template <template <class> class Element>
struct ElementType {
  template <class S>
  using Of = Element<S>;
};

/// A list of each kind of force element over a scalar S. The kinds and all members stand in
/// force_elements.hpp, which those include that use elements, and nobody else compiles again where one
/// changes.
template <class S>
class ForceElements {
 public:
  ForceElements();
  ForceElements(const ForceElements& other);
  ForceElements(ForceElements&& other) noexcept;
  ForceElements& operator=(const ForceElements& other);
  ForceElements& operator=(ForceElements&& other) noexcept;
  ~ForceElements();

  template <template <class> class One>
  std::vector<One<S>>& get();
  template <template <class> class One>
  const std::vector<One<S>>& get() const;

  template <class Type>
  std::vector<typename Type::template Of<S>>& getList(Type type);
  template <class Type>
  const std::vector<typename Type::template Of<S>>& getList(Type type) const;

  /// action(ElementType) of each kind, in the order of the file's keys.
  template <class Action>
  static void forEachType(Action action);
  /// action(list) of each kind.
  template <class Action>
  void forEachList(Action action);
  template <class Action>
  void forEachList(Action action) const;

 private:
  struct Lists;
  std::unique_ptr<Lists> lists_;  ///< never null, but where moved from
};

}  // namespace twinmap
