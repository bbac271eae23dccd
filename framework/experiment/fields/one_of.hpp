#pragma once

#include <optional>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace twinmap {

/// The alternative T of a variant, as a value that is given or not.
template <class T, class Variant>
struct Alternative {
  Variant& variant;
};

/// Whether a value is written out.
template <class T>
bool isGiven(const T&) {
  return true;
}
template <class T>
bool isGiven(const std::optional<T>& value) {
  return value.has_value();
}
template <class T>
bool isGiven(const std::vector<T>& values) {
  return !values.empty();
}
template <class T, class Variant>
bool isGiven(const Alternative<T, Variant>& alternative) {
  const T* held = std::get_if<T>(&alternative.variant);
  return held != nullptr && isGiven(*held);
}

/// One of several keys, its value and the rules of that.
template <class Value, class... Rule>
struct KeyChoice {
  const char* key;
  Value value;
  const char* what;
  std::tuple<Rule...> rules;
};

/// "One of" is described by a variant whose alternatives have a key each,
///
///   f.oneOf("must give one kind of feature:", choice<SamplesFeatureSpec>("samples", s, "..."), ...);
///
/// or by members that may be absent (optionals, lists), of which exactly one is given:
///
///   f.oneOf("must give exactly one of", choice("coordinate", s.coordinate, "..."), ...);
///
/// The rule's message ends in the list of keys.
template <class T, class... Alternatives, class... Rule>
KeyChoice<Alternative<T, std::variant<Alternatives...>>, Rule...> choice(
    const char* key, std::variant<Alternatives...>& variant, const char* what, const Rule&... rule) {
  return {key, {variant}, what, {rule...}};
}
template <class T, class... Rule>
KeyChoice<T&, Rule...> choice(const char* key, T& member, const char* what, const Rule&... rule) {
  return {key, member, what, {rule...}};
}

}  // namespace twinmap
