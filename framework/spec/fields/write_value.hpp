#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/spec/experiment_spec.hpp"
#include "framework/spec/fields/fields.hpp"
#include "framework/spec/yaml/number_text.hpp"
#include "framework/spec/yaml/yaml_node.hpp"

namespace twinmap {

YamlNode writeValue(double value);
YamlNode writeValue(int value);
YamlNode writeValue(bool value);
YamlNode writeValue(std::uint64_t value);
YamlNode writeValue(const std::string& value);
YamlNode writeValue(const Expression& value);
YamlNode writeValue(const Name& value);
YamlNode writeValue(const ComponentCount& value);
YamlNode writeValue(const Bounds& value);
YamlNode writeValue(const OutputNoiseSpec& value);
YamlNode writeValue(const Frequency& value);
YamlNode writeValue(const NamedExpression& value);
YamlNode writeValue(const ColumnSpec& value);
YamlNode writeValue(const MeasuredColumnSpec& value);

/// Writes the fields of a struct into a map, defaults included; what is not given is left out.
class FieldWriter {
 public:
  YamlNode takeMap() { return std::move(map_); }

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
  void rule(bool, const char*) const {}

 private:
  void add(const char* key, YamlNode value) { map_.entries.push_back({key, {}, std::move(value)}); }

  YamlNode map_ = makeMap();
};

template <class T>
YamlNode writeValue(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return makeScalar(getEnumText(value));
  } else {
    FieldWriter fields;
    describe(fields, const_cast<T&>(value));  // the writer takes every field by const reference
    return fields.takeMap();
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
inline bool isGiven(const ComponentCount& value) {
  return value.number.has_value();
}
inline bool isGiven(const Expression& value) {
  return !value.text.empty();
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

}  // namespace twinmap
