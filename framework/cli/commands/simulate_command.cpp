#include <algorithm>
#include <iostream>
#include <sstream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/measured_modes.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/check/check_noise.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap::cli {
namespace {

/// A sampled parameter's value for this simulation: "parameters.k_y=7.5".
struct ParameterValue {
  Name name;
  double value;
};

/// The name of a parameter that "parameters.NAME", "nuisance.NAME" or "inputs.NAME" sets; else "".
std::string findParameterName(const std::string& key) {
  for (const std::string prefix : {"parameters.", "nuisance.", "inputs."}) {
    if (key.rfind(prefix, 0) == 0 && key.find_first_of(".[", prefix.size()) == std::string::npos) {
      return key.substr(prefix.size());
    }
  }
  return "";
}

/// Takes the parameter values out of the overrides.
std::vector<ParameterValue> takeParameterValues(std::vector<std::string>& overrides) {
  std::vector<ParameterValue> values;
  std::vector<std::string> others;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const std::string name = equals == std::string::npos ? "" : findParameterName(key);
    if (name.empty()) {
      others.push_back(text);
      continue;
    }
    const SourceLocation where{"command line", 0, 0, key};
    double value = 0.0;
    if (!parseLiteral(text.substr(equals + 1), value)) {
      throw ExperimentError(where, text.substr(equals + 1), "must be a number");
    }
    values.push_back({{name, where}, value});
  }
  overrides = others;
  return values;
}

Eigen::VectorXd makePoint(const ModelSpec& model, const std::vector<ParameterValue>& values) {
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  const std::vector<std::string> names = collectNames(sampled);
  Eigen::VectorXd point = calcBoxCenter(sampled);
  for (const ParameterValue& given : values) {
    requireKnown(given.name, names, "a parameter");
    point[std::find(names.begin(), names.end(), given.name.text) - names.begin()] = given.value;
  }
  return point;
}

std::string makeModesCsv(const ResponseLayout& layout, const Eigen::VectorXd& response) {
  std::string csv = "mode,frequency,damping_ratio\n";
  for (int i = 0; i < layout.modes; ++i) {
    csv += std::to_string(i + 1) + "," + toText(response[layout.getFrequencyRow(i)]) + "," +
           toText(response[layout.getDampingRow(i)]) + "\n";
  }
  return csv;
}

std::string makeOutputsCsv(const ResponseLayout& layout, const Eigen::VectorXd& response) {
  std::vector<Column> columns{{"t", {}, layout.times}};
  for (Eigen::Index output = 0; output < layout.getOutputCount(); ++output) {
    columns.push_back(
        {layout.output_names[output], {}, response.segment(layout.getRow(output, 0), layout.times.size())});
  }
  std::ostringstream csv;
  writeTable(csv, columns);
  return csv.str();
}

/// The outputs, then the modes; an empty line between them where there are both.
std::string makeCsv(const ResponseLayout& layout, const Eigen::VectorXd& response) {
  const bool outputs = layout.times.size() > 0, modes = layout.modes > 0;
  return (outputs ? makeOutputsCsv(layout, response) : "") + (outputs && modes ? "\n" : "") +
         (modes ? makeModesCsv(layout, response) : "");
}

/// As infer reads them: modes beside outputs in a table of their own.
void writeFiles(const std::string& path, const ExperimentSpec& experiment, const ResponseLayout& layout,
                const Eigen::VectorXd& response) {
  if (layout.times.size() == 0 || layout.modes == 0) {
    writeTextFile(path, makeCsv(layout, response));
    return;
  }
  const std::filesystem::path modes = findModesFile(path, experiment.measurement);
  writeTextFile(path, makeOutputsCsv(layout, response));
  writeTextFile(modes, makeModesCsv(layout, response));
  std::cerr << "Modes: " << modes.string() << "\n";
}

}  // namespace

void simulate(const SimulateArguments& arguments) {
  std::vector<std::string> overrides = arguments.experiment.overrides;
  const std::vector<ParameterValue> values = takeParameterValues(overrides);
  const ExperimentSpec experiment =
      followNoise(readExperimentWithSignals(loadExperimentTree(arguments.experiment.file, overrides)));
  requireOneTrial(experiment, "a simulation is of one");
  const Eigen::MatrixXd point = makePoint(experiment.model, values);
  const std::unique_ptr<Simulator> made =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  Simulator& simulator = *made;
  Eigen::MatrixXd response(simulator.getLayout().getRowCount(), 1);
  SampleStatus status;
  simulator.simulate(point, response, &status);
  if (!status.ok) {
    throw std::runtime_error("the simulation failed: " + status.reason);
  }
  if (arguments.noise) {
    requireStatedNoise(experiment);
    response = addNoise(response, ResponseNoise(experiment.noise, simulator.getLayout()),
                        RandomStream(experiment.seed, RandomPurpose::kSingleNoise));
  }
  if (arguments.csv.empty()) {
    std::cout << makeCsv(simulator.getLayout(), response);
  } else {
    writeFiles(arguments.csv, experiment, simulator.getLayout(), response);
  }
}

}  // namespace twinmap::cli
