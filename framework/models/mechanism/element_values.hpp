#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/system_names.hpp"

// The numbers of force elements from what the file says: both structs have the same description, so that the
// fields of one, listed in their order, are the sources of the other's.

namespace twinmap::equations {

/// The fields of an element as the file gives it, in the order of its description. Of a part that may be
/// absent, first whether it is there.
class ElementSources {
 public:
  template <class T, class... Rule>
  void required(const char*, std::optional<T>& field, const char*, const Rule&...) {
    if constexpr (kIsPart<T>) {
      static constexpr bool kIsGiven[] = {false, true};
      fields_.push_back(&kIsGiven[field ? 1 : 0]);
      if (field) {
        describe(*this, *field);
      }
    } else {
      fields_.push_back(&field);
    }
  }
  template <class T, class... Rule>
  void required(const char*, T& field, const char*, const Rule&...) {
    if constexpr (kIsPart<T>) {
      describe(*this, field);
    } else {
      fields_.push_back(&field);
      if constexpr (std::is_same_v<T, Name>) {
        names_.push_back(field.text);
      }
    }
  }
  template <class T, class... Rule>
  void optional(const char* key, T& field, const char* what, const Rule&... rule) {
    required(key, field, what, rule...);
  }
  void rule(bool, const char*) const {}

  template <class T>
  const T& take() {
    return *static_cast<const T*>(fields_[next_++]);
  }
  /// "spring on 'x'", "bushing from 'a' to 'b'"
  std::string describeOwner(const char* noun) const {
    return noun + (names_.size() == 2 ? " from '" + names_[0] + "' to '" + names_[1] + "'"
                                      : " on '" + names_.at(0) + "'");
  }

 private:
  std::vector<const void*> fields_;
  std::vector<std::string> names_;
  std::size_t next_ = 0;
};

/// Whether an expression uses these names alone.
inline bool usesOnly(const DefinedNames& names, const Expression& expression) {
  const std::vector<std::string> used = getUsedNames(expression);
  return std::all_of(used.begin(), used.end(), [&](const std::string& name) { return names.contains(name); });
}

/// Fills the fields of an element over S. `Numbers`: calc(expression, owner, key, unit) gives an S,
/// knows(expression) says whether it can.
template <class S, class Numbers>
class ElementFiller {
 public:
  ElementFiller(ElementSources& sources, const char* noun, const SystemNames& names, Numbers& numbers)
      : sources_(sources), owner_(sources.describeOwner(noun)), names_(names), numbers_(numbers) {}

  template <class T, class... Rule>
  void required(const char* key, T& field, const char*, const Rule&... rule) {
    fill(key, field, rule...);
  }
  template <class T, class... Rule>
  void optional(const char* key, T& field, const char*, const Rule&... rule) {
    fill(key, field, rule...);
  }
  void rule(bool, const char*) const {}

 private:
  S calc(const Expression& expression, const std::string& key, const char* unit) {
    return numbers_.calc(expression, owner_, key.c_str(), unit);
  }
  algebra::Vec3<S> calc3(const Expression3& expressions, const std::string& key, const char* unit) {
    return {calc(expressions[0], key, unit), calc(expressions[1], key, unit),
            calc(expressions[2], key, unit)};
  }

  void fill(const char*, int& field, Reference reference) {
    const Name& name = sources_.take<Name>();
    field = reference == Reference::kBody               ? names_.findBody(name)
            : reference == Reference::kForcedCoordinate ? names_.findForcedCoordinate(name)
                                                        : names_.findCoordinate(name);
  }
  void fill(const char*, std::optional<int>& field, Reference) {
    const std::optional<Name>& name = sources_.take<std::optional<Name>>();
    if (name) {
      field = names_.findForcedCoordinate(*name);
    }
  }
  /// Numbers have no name.
  void fill(const char*, Nameless&) { sources_.take<std::optional<Name>>(); }
  /// The place of an element's own state follows when all elements are there.
  void fill(const char*, int&) { sources_.take<std::optional<Name>>(); }
  void fill(const char* key, std::optional<S>& field, const Unit& unit) {
    const std::optional<Expression>& expression = sources_.take<std::optional<Expression>>();
    if (expression) {
      field = calc(*expression, prefix_ + key, unit.rotation == nullptr ? unit.text : "");
    }
  }
  void fill(const char* key, S& field, const Unit& unit) {
    field = calc(sources_.take<Expression>(), prefix_ + key, unit.rotation == nullptr ? unit.text : "");
  }
  void fill(const char* key, algebra::Vec3<S>& field, const Unit& unit) {
    field = calc3(sources_.take<Expression3>(), prefix_ + key, unit.text);
  }
  void fill(const char* key, SixOf<S>& field, const Unit& unit) {
    constexpr int kRotations = 3;
    const SixOf<Expression>& expressions = sources_.take<SixOf<Expression>>();
    for (int i = 0; i < 2 * kRotations; ++i) {
      field[i] = calc(expressions[i], prefix_ + key, i < kRotations ? unit.rotation : unit.text);
    }
  }
  void fill(const char* key, algebra::Transform<S>& field) {
    const FrameSpec& frame = sources_.take<FrameSpec>();
    field = {rotateXyz(calc3(frame.orientation, prefix_ + key + ".orientation", "rad")),
             calc3(frame.point, prefix_ + key + ".point", "m")};
  }
  void fill(const char* key, StateNumber<S>& field, const Unit& unit) {
    const Expression& expression = sources_.take<Expression>();
    if (numbers_.knows(expression)) {
      field.value = calc(expression, prefix_ + key, unit.rotation == nullptr ? unit.text : "");
    } else {
      field.varying = &expression;
    }
  }
  void fill(const char*, const Expression*& field, const Unit&) { field = &sources_.take<Expression>(); }
  void fill(const char*, const Expression3*& field, const Unit&) { field = &sources_.take<Expression3>(); }
  template <class T>
  void fill(const char* key, std::optional<T>& field) {
    if (sources_.take<bool>()) {
      fill(key, field.emplace());
    }
  }
  template <class T>
  void fill(const char* key, T& field) {
    if constexpr (std::is_enum_v<T>) {
      field = sources_.take<T>();
    } else {
      prefix_ = std::string(key) + ".";
      describe(*this, field);
      prefix_.clear();
    }
  }

  ElementSources& sources_;
  std::string owner_, prefix_;
  const SystemNames& names_;
  Numbers& numbers_;
};

/// Tells elements where their own states are: behind the `first` ones, in their order.
template <class S>
void placeOwnStates(ForceElements<S>& elements, int first) {
  elements.forEachList([&first](auto& list) {
    for (auto& element : list) {
      forEachOwnState(element, [&first](auto& part, int) { part.state = first++; });
    }
  });
}

/// Tells friction whose speed is prescribed.
template <class S>
void findPrescribed(const SystemNames& names, ForceElements<S>& elements) {
  for (Friction<S>& friction : elements.template get<Friction>()) {
    friction.is_prescribed = names.isPrescribed(friction.coordinate) &&
                             (!friction.against || names.isPrescribed(*friction.against));
  }
}

/// Tells friction that sticks and what touches with damping their places among the modes of switches
/// (switches.hpp), of which rigid stops come first.
template <class S>
void placeSwitches(ForceElements<S>& elements) {
  int place = 0;
  for (const Stop<S>& stop : elements.template get<Stop>()) {
    place += stop.isRigid() ? 1 : 0;
  }
  for (Friction<S>& friction : elements.template get<Friction>()) {
    friction.mode = friction.switches() ? place++ : -1;
  }
  for (Stop<S>& stop : elements.template get<Stop>()) {
    stop.touch = stop.damping ? place++ : -1;
  }
  for (Contact<S>& contact : elements.template get<Contact>()) {
    contact.touch = contact.damping ? place++ : -1;
  }
}

/// The numbers of all force elements. `numbers`: as of ElementFiller; calc() may throw.
/// The numbers refer to expressions of `spec`, which must outlive them. Throws ExperimentError for unknown
/// names and for a force on a coordinate that takes none. `first_state`: how many states are not elements'
/// own.
template <class S, class Numbers>
ForceElements<S> calcElements(const ForceElements<Expression>& spec, const SystemNames& names,
                              Numbers&& numbers, int first_state) {
  ForceElements<S> elements;
  ForceElements<S>::forEachType([&](auto type) {
    using Spec = typename decltype(type)::template Of<Expression>;
    using Value = typename decltype(type)::template Of<S>;
    for (const Spec& one : spec.getList(type)) {
      ElementSources sources;
      describe(sources, const_cast<Spec&>(one));  // which are listed, not changed
      ElementFiller<S, std::remove_reference_t<Numbers>> filler(sources, Spec::kKind.noun, names, numbers);
      describe(filler, elements.getList(type).emplace_back(Value{}));
    }
  });
  placeOwnStates(elements, first_state);
  findPrescribed(names, elements);
  placeSwitches(elements);
  return elements;
}

}  // namespace twinmap::equations
