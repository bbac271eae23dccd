#include "framework/models/fmu/worker_job.hpp"

#include <algorithm>
#include <set>
#include <type_traits>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/tree/read_value.hpp"
#include "framework/experiment/tree/write_value.hpp"
#include "framework/models/fmu/run/bind_variables.hpp"

namespace twinmap::fmi {
namespace {

template <class Fields>
void describe(Fields& f, WorkerJob& s) {
  f.required("file", s.file, "");
  f.required("folder", s.folder, "");
  f.required("library", s.library, "");
  f.required("kind", s.kind, "");
  f.optionalMap("parameters", s.model.parameters, "");
  f.optionalMap("nuisance", s.model.nuisance, "");
  f.optionalMap("inputs", s.model.inputs, "");
  f.optionalMap("constants", s.model.constants, "");
  f.optionalMap("excitation", s.model.excitation, "");
  f.optionalMap("outputs", s.model.outputs, "");
  f.optional("simulation", s.model.simulation, "");
  f.optional("source", s.model.source, "");
  f.required("times", s.times, "");
}

bool hasVariable(const ModelDescription& description, const std::string& name) {
  return std::any_of(description.variables.begin(), description.variables.end(),
                     [&](const Variable& variable) { return variable.name == name; });
}

class NameCollector;

template <class T, class = void>
struct IsDescribed : std::false_type {};
template <class T>
struct IsDescribed<T, std::void_t<decltype(describe(std::declval<NameCollector&>(), std::declval<T&>()))>>
    : std::true_type {};

/// Keeps the names used by the expressions of described structs (fields.hpp), whatever key they stand under.
class NameCollector {
 public:
  std::set<std::string> names;

  template <class T>
  void visit(T& value) {
    if constexpr (IsDescribed<T>::value) {
      describe(*this, value);
    }
  }
  void visit(Expression& expression) {
    if (!expression.text.empty()) {
      const std::vector<std::string> used = getUsedNames(expression);
      names.insert(used.begin(), used.end());
    }
  }
  template <class T>
  void visit(std::vector<T>& values) {
    for (T& value : values) {
      visit(value);
    }
  }

  template <class T, class... Rule>
  void required(const char*, T& value, const char*, const Rule&...) {
    visit(value);
  }
  template <class T, class... Rule>
  void optional(const char*, T& value, const char*, const Rule&...) {
    visit(value);
  }
  template <class... Choice>
  void oneOf(const char*, const Choice&... choices) {
    (visit(choices.value), ...);
  }
  void rule(bool, const char*) {}
  void scalarIsValueOf(const char*) {}
};

/// Names in the expressions of constants, excitation and sensors.
std::set<std::string> collectUsedNames(const ModelSpec& model) {
  auto& described = const_cast<ModelSpec&>(model);  // nothing is written to it
  NameCollector collector;
  collector.visit(described.constants);
  collector.visit(described.excitation);
  collector.visit(described.outputs);
  return std::move(collector.names);
}

template <class Item>
VariableUse makeUse(const Item& item) {
  const Name& variable = item.variable ? *item.variable : item.name;
  return {variable.text, item.unit, variable.where};
}

/// Values in the order of the parameter point, then of the constants.
BoundVariables bindSettable(const ModelDescription& description, const ModelSpec& model) {
  const std::set<std::string> used = collectUsedNames(model);
  std::vector<VariableUse> uses;
  std::vector<std::size_t> sources;
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const bool elsewhere =
        used.count(sampled[i].name.text) > 0 && !hasVariable(description, sampled[i].name.text);
    if (sampled[i].variable || !elsewhere) {
      uses.push_back(makeUse(sampled[i]));
      sources.push_back(i);
    }
  }
  for (std::size_t i = 0; i < model.constants.size(); ++i) {
    if (model.constants[i].variable) {
      uses.push_back(makeUse(model.constants[i]));
      sources.push_back(sampled.size() + i);
    }
  }
  BoundVariables bound = bindParameters(description, uses);
  bound.sources = sources;
  return bound;
}

template <class Item>
std::vector<VariableUse> makeUses(const std::vector<Item>& items) {
  std::vector<VariableUse> uses;
  std::transform(items.begin(), items.end(), std::back_inserter(uses), makeUse<Item>);
  return uses;
}

}  // namespace

std::string writeWorkerJob(const WorkerJob& job) {
  FieldWriter fields;
  describe(fields, const_cast<WorkerJob&>(job));  // the writer takes every field by const reference
  return writeYaml(fields.takeNode());
}

WorkerJob readWorkerJob(const std::string& text) {
  const YamlNode node = parseYaml(text, "the worker's job");
  WorkerJob job;
  FieldReader fields(node);
  describe(fields, job);
  fields.finish();
  return job;
}

RunSetting makeRunSetting(const ModelDescription& description, Kind kind, const ModelSpec& model,
                          const std::vector<double>& times) {
  RunSetting setting;
  setting.kind = kind;
  setting.parameters = bindSettable(description, model);
  setting.inputs = bindInputs(description, makeUses(model.excitation));
  setting.outputs = bindOutputs(description, makeUses(model.outputs));
  setting.times = Eigen::Map<const Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
  setting.duration = model.simulation.duration;
  setting.step = model.source->fmu->step;
  setting.integration = {model.simulation.relative_tolerance, model.simulation.absolute_tolerance,
                         model.simulation.max_steps, model.simulation.max_wall_time};
  return setting;
}

std::optional<SensitivityPlan> makeSensitivityPlan(const ModelDescription& description,
                                                   const ModelSpec& model, const RunSetting& setting) {
  const std::set<std::string> used = collectUsedNames(model);
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  const bool elsewhere = std::any_of(sampled.begin(), sampled.end(), [&](const ParameterSpec& parameter) {
    return used.count(parameter.name.text) > 0;
  });
  return elsewhere ? std::nullopt : planSensitivities(description, setting, sampled.size());
}

Kind toKind(FmuKind kind) {
  return kind == FmuKind::kCoSimulation ? Kind::kCoSimulation : Kind::kModelExchange;
}

FmuKind toFmuKind(Kind kind) {
  return kind == Kind::kCoSimulation ? FmuKind::kCoSimulation : FmuKind::kModelExchange;
}

}  // namespace twinmap::fmi
