#include "framework/spec/fields/json_schema.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/spec/describe_experiment.hpp"
#include "framework/spec/describe_sweep.hpp"

namespace twinmap {
namespace {

using Json = nlohmann::ordered_json;

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
Json makeSchema(const OutputNoiseSpec&) {
  return {{"type", "number"}, {"minimum", 0}};
}
Json makeSchema(const Frequency&) {
  return {{"type", "number"}, {"exclusiveMinimum", 0}};
}
Json makeSchema(const NamedExpression&) {
  return makeSchema(Expression{});
}
Json makeSchema(const ColumnSpec&) {
  return {{"type", "string"}};
}
Json makeSchema(const MeasuredColumnSpec&) {
  return makeSchema(ColumnSpec{});
}
Json makeSchema(const Bounds&) {
  return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
}

Json makeSchema(const ComponentCount&) {
  const Json automatic{{"const", "automatic"}};
  const Json number{{"type", "integer"}, {"minimum", 1}};
  return {{"anyOf", Json::array({number, automatic})}};
}

Json makeSchema(const SweptKeys&) {
  const Json list{{"type", "array"}, {"minItems", 1}};
  const Json range{{"type", "string"}, {"pattern", "^-?[0-9]+\\.\\.-?[0-9]+$"}};
  return {{"type", "object"}, {"additionalProperties", {{"anyOf", Json::array({list, range})}}}};
}

template <class T>
Json makeStructSchema();
template <class T>
Json makeSchema(const std::vector<T>&);
template <class T, std::size_t N>
Json makeSchema(const std::array<T, N>&);
template <class T>
Json makeSchema(const std::optional<T>&);
template <class T>
Json makeSchema(const T&);

Json makeSchema(const TransformStepSpec&) {
  const Json names{{"enum", {"z_score", "whiten", "principal_components", "partial_least_squares"}}};
  return {{"anyOf", Json::array({names, makeStructSchema<TransformStepSpec>()})}};
}
Json makeSchema(const BaselineSpec&) {
  const Json names{{"enum", {"prior_mean", "linear_regression", "least_squares"}}};
  return {{"anyOf", Json::array({names, makeStructSchema<BaselineSpec>()})}};
}
Json makeSchema(const ConstantSpec&) {
  return {{"anyOf", Json::array({makeSchema(Expression{}), makeStructSchema<ConstantSpec>()})}};
}
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

/// Collects the fields of a struct into the schema of an object (see fields.hpp).
class FieldSchema {
 public:
  template <class T, class... Rule>
  void required(const char* key, const T& value, const char* what, const Rule&... rule) {
    required_.push_back(key);
    optional(key, value, what, rule...);
  }
  template <class T, class... Rule>
  void optional(const char* key, const T& value, const char* what, const Rule&... rule) {
    Json schema = makeSchema(value);
    (addRule(schema, rule), ...);
    add(key, std::move(schema), what);
  }
  template <class T>
  void requiredMap(const char* key, const std::vector<T>& values, const char* what) {
    required_.push_back(key);
    optionalMap(key, values, what);
  }
  template <class T>
  void optionalMap(const char* key, const std::vector<T>&, const char* what) {
    add(key, {{"type", "object"}, {"additionalProperties", makeSchema(T{})}}, what);
  }
  void rule(bool, const char*) const {}

  Json makeObject() const {
    Json object{{"type", "object"}, {"additionalProperties", false}, {"properties", properties_}};
    if (!required_.empty()) {
      object["required"] = required_;
    }
    return object;
  }

 private:
  void add(const char* key, Json schema, const char* what) {
    schema["description"] = what;
    properties_[key] = std::move(schema);
  }

  Json properties_ = Json::object();
  std::vector<std::string> required_;
};

template <class T>
Json makeStructSchema() {
  FieldSchema fields;
  T value{};
  describe(fields, value);
  return fields.makeObject();
}

}  // namespace

std::string makeJsonSchema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "twinmap experiment"}};
  schema.update(makeStructSchema<ExperimentSpec>());
  schema["properties"]["sweep"] = makeStructSchema<SweepSpec>();
  schema["properties"]["sweep"]["description"] = "repeats the experiment with other values";
  constexpr int kIndent = 2;
  return schema.dump(kIndent) + "\n";
}

}  // namespace twinmap
