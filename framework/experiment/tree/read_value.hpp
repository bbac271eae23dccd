#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/text/nearest_name.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

// One overload for each type of value in the experiment file. All throw ExperimentError with the node's
// place, its value and the rule it breaks.

/// Decimal numbers; refuses inf, nan, quoted numbers and leading zeros (octal in YAML 1.1).
void readValue(const YamlNode& node, double& value, const NumberRule& rule = kAnyNumber);
/// Whole numbers, also written as 1e3.
void readValue(const YamlNode& node, int& value, const NumberRule& rule = kAnyNumber);
/// Whole numbers from 0 to 2^53 - 1.
void readValue(const YamlNode& node, std::uint64_t& value);
/// true or false; yes, no, on, off and numbers are refused.
void readValue(const YamlNode& node, bool& value);
void readValue(const YamlNode& node, std::string& value);
void readValue(const YamlNode& node, Expression& value);
void readValue(const YamlNode& node, Name& value);
/// [lower, upper] with lower < upper.
void readValue(const YamlNode& node, Bounds& value);
/// "NAME" or "NAME [unit]".
void readValue(const YamlNode& node, ColumnSpec& value);
/// A whole number above 0, or automatic.
void readValue(const YamlNode& node, ComponentCount& value);
void readValue(const YamlNode& node, SampleCount& value);
/// A number, or automatic.
void readValue(const YamlNode& node, Tolerance& value, const NumberRule& rule);
/// A number, or unknown.
void readValue(const YamlNode& node, NoiseStddev& value, const NumberRule& rule);
/// A map from parameters to weights above 0.
void readValue(const YamlNode& node, ParameterWeights& value);
/// A map from key paths to [lower, upper] or {each: [lower, upper]}.
void readValue(const YamlNode& node, FreeValues& value);

/// Throws unless `node` is of the kind; the message says what was expected.
void requireKind(const YamlNode& node, YamlNode::Kind kind, const std::string& expected);

/// Throws unless `node` is a list of so many values.
void requireLength(const YamlNode& node, std::size_t count);

/// Throws unless `key` is an identifier: a letter or '_', then letters, digits or '_'.
void requireIdentifier(const Name& name);

/// Reads a node into the fields of a struct (see fields.hpp).
class FieldReader {
 public:
  explicit FieldReader(const YamlNode& node) : node_(&node) {}
  FieldReader(const FieldReader&) = delete;
  FieldReader& operator=(const FieldReader&) = delete;

  template <class T, class... Rule>
  void required(const char* key, T& value, const char* /*what*/, const Rule&... rule);
  template <class T, class... Rule>
  void optional(const char* key, T& value, const char* /*what*/, const Rule&... rule);
  template <class T>
  void requiredMap(const char* key, std::vector<T>& values, const char* /*what*/);
  template <class T>
  void optionalMap(const char* key, std::vector<T>& values, const char* /*what*/);
  template <class... Choices>
  void oneOf(const char* text, Choices... choices);
  void rule(bool holds, const char* text);
  template <class T, class... Rule>
  void value(T& value, const Rule&... rule);
  void scalarIsKey();
  void scalarIsValueOf(const char* key);
  void location(SourceLocation& where) const { where = node_->where; }

  /// Throws for a key that no field asked for, with the nearest known one, or the one that is missing; then
  /// for a missing key, then for the first broken rule: a misspelt key may have caused both.
  void finish() const;

 private:
  const YamlNode* take(const char* key);
  /// Null, which finish() tells, if the key is missing.
  const YamlNode* takeRequired(const char* key, const char* what);
  template <class Choice>
  int readChoice(Choice& choice);
  void requireOne(int given, const char* text, std::initializer_list<const char*> keys);
  void setMap(const std::string& key, YamlNode value);

  const YamlNode* node_;
  YamlNode written_out_;   ///< the map that a scalar is short for
  bool is_value_ = false;  ///< not a map
  [[noreturn]] void refuse(const YamlEntry& unknown) const;

  std::vector<std::string> known_;
  std::vector<std::pair<std::string, std::string>> missing_;  ///< required keys, and what they are
  std::string broken_rule_;
};

template <class T>
void readStruct(const YamlNode& node, T& value) {
  FieldReader fields(node);
  describe(fields, value);
  fields.finish();
}

template <class Enum>
void readEnum(const YamlNode& node, Enum& value) {
  requireKind(node, YamlNode::Kind::kScalar, "a name");
  std::vector<std::string> names;
  for (const EnumName<Enum>& name : EnumNames<Enum>::values) {
    if (node.scalar == name.text) {
      value = name.value;
      return;
    }
    names.emplace_back(name.text);
  }
  throw ExperimentError(node.where, node.scalar,
                        "must be one of " + listNames(names) + suggestName(node.scalar, names));
}

template <class T>
void readValue(const YamlNode& node, T& value) {
  if constexpr (std::is_enum_v<T>) {
    readEnum(node, value);
  } else {
    readStruct(node, value);
  }
}

template <class T, class... Rule>
void readValue(const YamlNode& node, std::optional<T>& value, const Rule&... rule) {
  readValue(node, value.emplace(), rule...);
}

template <class T, class Variant, class... Rule>
void readValue(const YamlNode& node, Alternative<T, Variant>& alternative, const Rule&... rule) {
  T value{};
  readValue(node, value, rule...);
  alternative.variant.template emplace<T>(std::move(value));
}

template <class T>
void readValue(const YamlNode& node, std::vector<T>& values, const ListRule& rule = {}) {
  constexpr std::size_t kMax = 10000;
  requireKind(node, YamlNode::Kind::kSequence, "a list");
  if (node.items.size() < rule.minimum) {
    throw ExperimentError(node.where, "[]", rule.text);
  }
  if (!std::is_arithmetic_v<T> && node.items.size() > kMax) {
    throw ExperimentError(node.where, "", "must list at most 10000");
  }
  values.assign(node.items.size(), T{});
  for (std::size_t i = 0; i < values.size(); ++i) {
    readValue(node.items[i], values[i]);
  }
}

template <class T, std::size_t N>
void readValue(const YamlNode& node, std::array<T, N>& values) {
  requireLength(node, N);
  for (std::size_t i = 0; i < N; ++i) {
    readValue(node.items[i], values[i]);
  }
}

template <class T>
void readMap(const YamlNode& node, std::vector<T>& values) {
  constexpr std::size_t kMax = 1000;
  requireKind(node, YamlNode::Kind::kMap, "a map from names to values");
  if (node.entries.size() > kMax) {
    throw ExperimentError(node.where, "", "must name at most 1000");
  }
  values.clear();
  for (const YamlEntry& entry : node.entries) {
    T value{};
    value.name = {entry.key, entry.key_where};
    requireIdentifier(value.name);
    readValue(entry.value, value);
    values.push_back(std::move(value));
  }
}

template <class T>
void readByRule(const YamlNode& node, T& value) {
  readValue(node, value);
}

/// By the one rule among them, if any, that the value alone must satisfy.
template <class T, class Rule, class... Others>
void readByRule(const YamlNode& node, T& value, const Rule& rule, const Others&... others) {
  if constexpr (kIsCheckedLater<Rule>) {
    readByRule(node, value, others...);
  } else {
    static_assert((kIsCheckedLater<Others> && ...));
    readValue(node, value, rule);
  }
}

template <class T, class... Rule>
void FieldReader::required(const char* key, T& value, const char* what, const Rule&... rule) {
  if (const YamlNode* node = takeRequired(key, what)) {
    readByRule(*node, value, rule...);
  }
}

template <class T, class... Rule>
void FieldReader::optional(const char* key, T& value, const char*, const Rule&... rule) {
  if (const YamlNode* node = take(key)) {
    readByRule(*node, value, rule...);
  }
}

template <class T>
void FieldReader::requiredMap(const char* key, std::vector<T>& values, const char* what) {
  const YamlNode* node = takeRequired(key, what);
  if (node == nullptr) {
    return;
  }
  readMap(*node, values);
  if (values.empty()) {
    throw ExperimentError(node->where, "{}", "must name at least one; " + std::string(what));
  }
}

template <class T>
void FieldReader::optionalMap(const char* key, std::vector<T>& values, const char*) {
  if (const YamlNode* node = take(key)) {
    readMap(*node, values);
  }
}

/// 1 if the choice is given, else 0.
template <class Choice>
int FieldReader::readChoice(Choice& choice) {
  const YamlNode* node = take(choice.key);
  if (node == nullptr) {
    return 0;
  }
  std::apply([&](const auto&... rule) { readByRule(*node, choice.value, rule...); }, choice.rules);
  return isGiven(choice.value) ? 1 : 0;
}

template <class... Choices>
void FieldReader::oneOf(const char* text, Choices... choices) {
  int given = 0;
  ((given += readChoice(choices)), ...);
  requireOne(given, text, {choices.key...});
}

template <class T, class... Rule>
void FieldReader::value(T& value, const Rule&... rule) {
  is_value_ = true;
  readByRule(*node_, value, rule...);
}

}  // namespace twinmap
