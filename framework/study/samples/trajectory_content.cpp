#include "framework/study/samples/trajectory_content.hpp"

#include <algorithm>
#include <filesystem>

#include "framework/base/files/digest.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/tree/write_value.hpp"

namespace twinmap {
namespace {

void erase(YamlNode& map, const std::string& key) {
  auto& entries = map.entries;
  entries.erase(
      std::remove_if(entries.begin(), entries.end(), [&](const YamlEntry& e) { return e.key == key; }),
      entries.end());
}

/// What of a model from elsewhere determines a response.
struct SourceContent {
  std::vector<std::string> variables, units;
  std::string fmu;
  std::optional<FmuKind> kind;
  std::optional<double> step;
  std::vector<std::string> command, files;  ///< of a program; digests of the files it names and depends on
  std::vector<EnvironmentSpec> environment;
  std::optional<double> excitation_interval;
};

template <class Fields>
void describe(Fields& f, SourceContent& s) {
  f.required("variables", s.variables, "");
  f.required("units", s.units, "");
  f.required("fmu", s.fmu, "");
  f.optional("kind", s.kind, "");
  f.optional("step", s.step, "");
  f.optional("command", s.command, "");
  f.optional("files", s.files, "");
  f.optionalMap("environment", s.environment, "");
  f.optional("excitation_interval", s.excitation_interval, "");
}

YamlNode writeSimulation(SimulationSpec simulation) {
  simulation.relative_tolerance.automatic = simulation.absolute_tolerance.automatic = false;
  YamlNode map = writeValue(simulation);
  erase(map, "max_wall_time");
  erase(map, "allowed_failures");
  erase(map, "portable");  // what the samples are computed with says it (writeStoreContent)
  return map;
}

template <class T>
std::vector<T> withoutUnits(std::vector<T> items) {
  for (T& item : items) {
    item.unit.clear();
  }
  return items;
}

std::vector<ConstantSpec> withoutTexts(std::vector<ConstantSpec> constants) {
  for (ConstantSpec& constant : constants) {
    constant.description.clear();
  }
  return withoutUnits(std::move(constants));
}

/// What bodies look like decides nothing.
SystemSpec withoutShapes(SystemSpec system) {
  for (BodySpec& body : system.bodies) {
    body.shapes.clear();
  }
  return system;
}

/// A table's values and the delay of its clock count, not where they come from.
std::vector<SignalSpec> withoutSources(std::vector<SignalSpec> signals) {
  for (SignalSpec& signal : signals) {
    for (TableSpec& table : signal.tables) {
      std::optional<MeasuredSignalSpec> delayed;
      if (const Expression* delay = table.findDelay()) {
        delayed.emplace().delay = *delay;
      }
      table.measured = std::move(delayed);
    }
  }
  return withoutUnits(std::move(signals));
}

std::vector<double> calcCenter(const std::vector<ParameterSpec>& sampled) {
  const Eigen::VectorXd center = calcBoxCenter(sampled);
  return {center.begin(), center.end()};
}

bool startsAtBoxCenter(const InitialSpec& initial) {
  return initial.equilibrium && initial.equilibrium->at == EquilibriumAt::kBoxCenter;
}

/// Of the files that the command names and those that the program depends on, wherever their folder lies.
std::vector<std::string> calcFileDigests(const ProgramSpec& program) {
  const std::filesystem::path folder = program.working_folder;
  std::vector<std::string> digests;
  for (const std::vector<std::string>* names : {&program.command, &program.depends_on}) {
    for (const std::string& name : *names) {
      std::error_code ignored;
      const bool is_file = std::filesystem::is_regular_file(folder / name, ignored);
      digests.push_back(is_file ? toHex(calcFileDigest(folder / name)) : "");
    }
  }
  return digests;
}

/// The names of variables, and the FMU's bytes, wherever it lies; how much memory it may take decides
/// nothing.
SourceContent describeSource(const SourceSpec& source, const std::vector<ParameterSpec>& sampled) {
  SourceContent content;
  for (const ParameterSpec& parameter : sampled) {
    content.variables.push_back((parameter.variable ? *parameter.variable : parameter.name).text);
    content.units.push_back(parameter.unit);
  }
  if (source.fmu) {
    content.fmu = toHex(calcFileDigest(source.fmu->file.text));
    content.kind = source.fmu->kind;
    content.step = source.fmu->step;
  }
  if (source.program) {
    content.command = source.program->command;
    content.files = calcFileDigests(*source.program);
    content.environment = source.program->environment;
    content.excitation_interval = source.program->excitation_interval;
  }
  return content;
}

YamlNode writeResponse(const ResponseLayout& layout) {
  // A new member must be written here, or left out on purpose: the binding then no longer compiles.
  const auto& [output_names, output_units, times, modes] = layout;
  FieldWriter response;
  response.required("outputs", output_names, "");
  response.required("times", std::vector<double>(times.data(), times.data() + times.size()), "");
  response.required("modes", modes, "");
  return response.takeNode();
}

}  // namespace

std::string writeTrajectoryContent(const ModelSpec& model, const ResponseLayout& layout) {
  // A new member must be written here, or left out on purpose: the binding then no longer compiles.
  const auto& [parameters, nuisance, inputs, priors, constants, system, source, excitation, initial, outputs,
               simulation, time_origin, trials] = model;
  static_cast<void>(priors);  // no response depends on what is known of its parameters
  const std::vector<ParameterSpec> sampled = collectSampled(model);  // all three; which is which is no matter
  FieldWriter content;
  content.required("parameters", collectNames(sampled), "");
  if (startsAtBoxCenter(initial)) {
    content.required("box_center", calcCenter(sampled), "");
  }
  content.requiredMap("constants", withoutTexts(constants), "");
  if (source) {
    content.required("model", describeSource(*source, sampled), "");
  } else {
    content.required("system", withoutShapes(system), "");
  }
  content.requiredMap("excitation", withoutSources(excitation), "");
  content.required("initial", initial, "");
  content.requiredMap("outputs", outputs, "");
  YamlNode root = content.takeNode();
  root.entries.push_back({"simulation", {}, writeSimulation(simulation)});
  if (time_origin) {
    root.entries.push_back({"time_origin", {}, writeValue(*time_origin)});
  }
  for (const TrialModel& trial : trials) {
    root.entries.push_back({trial.name, {}, parseYaml(writeTrajectoryContent(trial.model, {}), trial.name)});
  }
  root.entries.push_back({"response", {}, writeResponse(layout)});
  return writeYaml(root);
}

}  // namespace twinmap
