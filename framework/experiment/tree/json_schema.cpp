#include "framework/experiment/tree/json_schema.hpp"

#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/tracking_spec.hpp"
#include "framework/experiment/tree/sweep_spec.hpp"

namespace twinmap {
namespace {

// One overload for each type of value, like readValue.
Json makeSchema(const double&) {
  return {{"type", "number"}};
}
Json makeSchema(const int&) {
  return {{"type", "integer"}};
}
Json makeSchema(const std::uint64_t&) {
  return {{"type", "integer"}, {"minimum", 0}};
}
Json makeSchema(const bool&) {
  return {{"type", "boolean"}};
}
Json makeSchema(const std::string&) {
  return {{"type", "string"}};
}
Json makeSchema(const Name&) {
  return {{"type", "string"}};
}
Json makeSchema(const Expression&) {
  return {{"type", {"number", "string"}}};
}
Json makeSchema(const ColumnSpec&) {
  return {{"type", "string"}};
}
Json makeSchema(const Bounds&) {
  return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
}

Json orAutomatic(const Json& number) {
  return {{"oneOf", Json::array({number, Json{{"const", "automatic"}}})}};
}

Json makeCountOrAutomatic(const NumberRule& rule) {
  return orAutomatic({{"type", "integer"}, {"minimum", rule.minimum}, {"maximum", rule.maximum}});
}
Json makeSchema(const ComponentCount&) {
  return makeCountOrAutomatic(kCount);
}
Json makeSchema(const SampleCount&) {
  return makeCountOrAutomatic(kSampleCount);
}

Json makeSchema(const Tolerance&) {
  return {{"type", "number"}};
}

Json makeSchema(const NoiseStddev&) {
  return {{"oneOf", Json::array({Json{{"type", "number"}, {"minimum", 0}}, Json{{"const", "unknown"}}})}};
}

Json makeSchema(const ParameterWeights&) {
  return {{"type", "object"},
          {"additionalProperties", {{"type", "number"}, {"exclusiveMinimum", 0}}},
          {"minProperties", 1}};
}

Json makeSchema(const FreeValues&) {
  const Json bounds = makeSchema(Bounds{});
  const Json each{{"type", "object"},
                  {"additionalProperties", false},
                  {"properties", {{"each", bounds}}},
                  {"required", Json::array({"each"})}};
  return {{"type", "object"},
          {"additionalProperties", {{"oneOf", Json::array({bounds, each})}}},
          {"minProperties", 1}};
}

Json makeSchema(const SweptKeys&) {
  const Json list{{"type", "array"}, {"minItems", 1}};
  const Json range{{"type", "string"}, {"pattern", "^-?[0-9]+\\.\\.-?[0-9]+$"}};
  return {{"type", "object"}, {"additionalProperties", {{"oneOf", Json::array({list, range})}}}};
}

template <class T>
Json makeStructSchema();
template <class T>
Json makeSchema(const std::vector<T>&);
template <class T, std::size_t N>
Json makeSchema(const std::array<T, N>&);
template <class T>
Json makeSchema(const std::optional<T>&);
template <class T, class Variant>
Json makeSchema(const Alternative<T, Variant>&);
template <class T>
Json makeSchema(const T&);

template <class T>
Json makeSchema(const std::vector<T>&) {
  return {{"type", "array"}, {"items", makeSchema(T{})}};
}
template <class T, std::size_t N>
Json makeSchema(const std::array<T, N>&) {
  return {{"type", "array"}, {"items", makeSchema(T{})}, {"minItems", N}, {"maxItems", N}};
}
template <class T>
Json makeSchema(const std::optional<T>&) {
  return makeSchema(T{});
}
template <class T, class Variant>
Json makeSchema(const Alternative<T, Variant>&) {
  return makeSchema(T{});
}
template <class T>
Json makeSchema(const T&) {
  if constexpr (std::is_enum_v<T>) {
    Json names = Json::array();
    for (const EnumName<T>& name : EnumNames<T>::values) {
      names.push_back(name.text);
    }
    return {{"enum", names}};
  } else {
    return makeStructSchema<T>();
  }
}

void addRule(Json& schema, const NumberRule& rule) {
  if (std::isfinite(rule.minimum)) {
    schema[rule.minimum_allowed ? "minimum" : "exclusiveMinimum"] = rule.minimum;
  }
  if (std::isfinite(rule.maximum)) {
    schema["maximum"] = rule.maximum;
  }
}

void addRule(Json& schema, const ListRule& rule) {
  schema["minItems"] = rule.minimum;
}

void addRule(Json& schema, const Unit& unit) {
  const std::string alternative = unit.rotation != nullptr ? std::string(" or ") + unit.rotation : "";
  const std::string what = schema.value("description", "");
  if (*unit.text != '\0') {
    schema["description"] = what + (what.empty() ? "" : "; ") + unit.text + alternative;
  }
}

void addRule(Json&, const Reference&) {}

/// The default of an optional key, where it can be said in one word.
template <class T>
void addDefault(Json& schema, const T& value) {
  if constexpr (std::is_enum_v<T>) {
    schema["default"] = getEnumText(value);
  } else if constexpr (std::is_arithmetic_v<T>) {
    schema["default"] = value;
  } else if constexpr (std::is_same_v<T, Expression>) {
    schema["default"] = value.text;
  }
  if (schema.value("default", Json()) == "") {
    schema.erase("default");
  }
}

/// Whether a map without keys is valid.
bool acceptsNoKeys(const Json& schema) {
  return !schema.contains("required") && !schema.contains("oneOf");
}

/// Collects the fields of a struct into its schema (see fields.hpp).
class FieldSchema {
 public:
  template <class T, class... Rule>
  void required(const char* key, const T& value, const char* what, const Rule&... rule) {
    required_.push_back(key);
    add(key, value, what, rule...);
  }
  template <class T, class... Rule>
  void optional(const char* key, const T& value, const char* what, const Rule&... rule) {
    addDefault(add(key, value, what, rule...), value);
  }
  template <class T>
  void requiredMap(const char* key, const std::vector<T>& values, const char* what) {
    required_.push_back(key);
    optionalMap(key, values, what);
  }
  template <class T>
  void optionalMap(const char* key, const std::vector<T>&, const char* what) {
    properties_[key] = {{"type", "object"}, {"additionalProperties", makeSchema(T{})}, {"description", what}};
  }
  template <class... Choices>
  void oneOf(const char* /*text*/, const Choices&... choices) {
    (addChoice(choices), ...);
  }
  template <class T, class... Rule>
  void value(const T& value, const Rule&... rule) {
    value_ = makeSchema(value);
    (addRule(value_, rule), ...);
  }
  void rule(bool, const char*) const {}
  void scalarIsKey() { scalar_is_key_ = true; }
  void scalarIsValueOf(const char* key) { value_key_ = key; }
  void location(const SourceLocation&) const {}

  Json getSchema() const {
    if (!value_.is_null()) {
      return value_;
    }
    const Json scalar = makeScalar();
    return scalar.is_null() ? makeObject() : Json{{"oneOf", Json::array({scalar, makeObject()})}};
  }

 private:
  template <class T, class... Rule>
  Json& add(const char* key, const T& value, const char* what, const Rule&... rule) {
    Json schema = makeSchema(value);
    if constexpr (std::is_same_v<T, Tolerance>) {
      (addRule(schema, rule), ...);
      schema = orAutomatic(schema);
      schema["description"] = what;
    } else {
      schema["description"] = what;
      (addRule(schema, rule), ...);
    }
    return properties_[key] = std::move(schema);
  }
  template <class Choice>
  void addChoice(const Choice& choice) {
    std::apply([&](const auto&... rule) { add(choice.key, choice.value, choice.what, rule...); },
               choice.rules);
    choices_.push_back(Json{{"required", Json::array({choice.key})}});
  }

  Json makeObject() const {
    Json object{{"type", "object"}, {"additionalProperties", false}, {"properties", properties_}};
    if (!required_.empty()) {
      object["required"] = required_;
    }
    if (!choices_.empty()) {
      object["oneOf"] = choices_;
    }
    return object;
  }

  /// What a scalar may be; null if only a map will do.
  Json makeScalar() const {
    if (!value_key_.empty()) {
      Json schema = properties_[value_key_];
      schema.erase("description");
      return schema;
    }
    return scalar_is_key_ ? Json{{"enum", listDefaults()}} : Json();
  }

  /// The choices that need no keys of their own.
  Json listDefaults() const {
    Json keys = Json::array();
    for (const auto& [key, schema] : properties_.items()) {
      if (acceptsNoKeys(schema)) {
        keys.push_back(key);
      }
    }
    return keys;
  }

  Json properties_ = Json::object();
  std::vector<std::string> required_;
  Json choices_ = Json::array();
  Json value_;
  std::string value_key_;
  bool scalar_is_key_ = false;
};

template <class T>
Json makeStructSchema() {
  FieldSchema fields;
  T value{};
  describe(fields, value);
  return fields.getSchema();
}

}  // namespace

std::string makeJsonSchema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "twinmap experiment"}};
  schema.update(makeStructSchema<ExperimentSpec>());
  schema["properties"]["sweep"] = makeStructSchema<SweepSpec>();
  schema["properties"]["sweep"]["description"] = "repeats the experiment with other values";
  schema["properties"]["tracking"] = makeStructSchema<TrackingSpec>();
  schema["properties"]["tracking"]["description"] = "how parameters move over time, for track";
  schema["properties"]["trials"] = {
      {"type", "object"},
      {"additionalProperties", {{"type", "object"}}},
      {"description", "several experiments with one machine: sections that differ, by name of the trial"}};
  schema["properties"]["trial"] = {{"type", "string"}, {"description", "the one trial that is meant"}};
  constexpr int kIndent = 2;
  return formatJson(schema, kIndent) + "\n";
}

}  // namespace twinmap
