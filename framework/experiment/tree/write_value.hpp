#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

YamlNode writeValue(double value);
YamlNode writeValue(int value);
YamlNode writeValue(bool value);
YamlNode writeValue(std::uint64_t value);
YamlNode writeValue(const std::string& value);
YamlNode writeValue(const Expression& value);
YamlNode writeValue(const Name& value);
YamlNode writeValue(const ComponentCount& value);
YamlNode writeValue(const SampleCount& value);
YamlNode writeValue(const Tolerance& value);
YamlNode writeValue(const NoiseStddev& value);
YamlNode writeValue(const Bounds& value);
YamlNode writeValue(const ColumnSpec& value);
YamlNode writeValue(const ParameterWeights& value);
YamlNode writeValue(const FreeValues& value);

inline bool isGiven(const ComponentCount& value) {
  return value.number.has_value();
}
inline bool isGiven(const Bounds& value) {
  return value.isGiven();
}
inline bool isGiven(const Expression& value) {
  return !value.text.empty();
}

/// Writes the fields of a struct, defaults included; what is not given is left out.
class FieldWriter {
 public:
  YamlNode takeNode() { return std::move(node_); }

  template <class T, class... Rule>
  void required(const char* key, const T& value, const char* /*what*/, const Rule&...);
  template <class T, class... Rule>
  void optional(const char* key, const T& value, const char* what, const Rule&... rule) {
    required(key, value, what, rule...);
  }
  template <class T>
  void requiredMap(const char* key, const std::vector<T>& values, const char* /*what*/);
  template <class T>
  void optionalMap(const char* key, const std::vector<T>& values, const char* what) {
    requiredMap(key, values, what);
  }
  template <class... Choices>
  void oneOf(const char* /*text*/, const Choices&... choices) {
    (required(choices.key, choices.value, choices.what), ...);
  }
  template <class T, class... Rule>
  void value(const T& value, const Rule&...);
  void rule(bool, const char*) const {}
  void scalarIsKey() const {}
  void scalarIsValueOf(const char* /*key*/) const {}
  void location(const SourceLocation&) const {}

 private:
  void add(const char* key, YamlNode value) { node_.entries.push_back({key, {}, std::move(value)}); }

  YamlNode node_ = makeMap();
};

template <class T>
YamlNode writeValue(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return makeScalar(getEnumText(value));
  } else {
    FieldWriter fields;
    describe(fields, const_cast<T&>(value));  // the writer takes every field by const reference
    return fields.takeNode();
  }
}

template <class Container>
YamlNode writeSequence(const Container& values) {
  YamlNode sequence = makeSequence();
  for (const auto& value : values) {
    sequence.items.push_back(writeValue(value));
  }
  return sequence;
}

template <class T>
YamlNode writeValue(const std::vector<T>& values) {
  return writeSequence(values);
}

template <class T, std::size_t N>
YamlNode writeValue(const std::array<T, N>& values) {
  return writeSequence(values);
}

template <class T>
YamlNode writeValue(const std::optional<T>& value) {
  return writeValue(*value);
}

template <class T, class Variant>
YamlNode writeValue(const Alternative<T, Variant>& alternative) {
  return writeValue(std::get<T>(alternative.variant));
}

template <class T, class... Rule>
void FieldWriter::required(const char* key, const T& value, const char*, const Rule&...) {
  if (isGiven(value)) {
    add(key, writeValue(value));
  }
}

template <class T>
void FieldWriter::requiredMap(const char* key, const std::vector<T>& values, const char*) {
  if (values.empty()) {
    return;
  }
  YamlNode map = makeMap();
  for (const T& value : values) {
    map.entries.push_back({value.name.text, {}, writeValue(value)});
  }
  add(key, std::move(map));
}

template <class T, class... Rule>
void FieldWriter::value(const T& value, const Rule&...) {
  node_ = writeValue(value);
}

}  // namespace twinmap
