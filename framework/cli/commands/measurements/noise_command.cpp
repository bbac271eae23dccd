#include <algorithm>
#include <iostream>

#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/noise/signal_noise.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/output_units.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap::cli {
namespace {

/// The outputs of the experiment, or those of them that were named, as its `measurement` says.
NoiseQuestion askForOutputs(const ExperimentSpec& experiment, const std::vector<std::string>& wanted) {
  const MeasurementSpec& spec = experiment.measurement;
  const ModelSpec& model = experiment.model;
  NoiseQuestion question{makeTimeBase(spec, spec.start.time), {}, {}};
  for (const std::string& name : wanted) {
    requireKnown({name, {"--columns", 0, 0, ""}}, collectNames(model.outputs), "an output");
  }
  for (const OutputSpec& output : model.outputs) {
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), output.name.text) != wanted.end()) {
      question.columns.push_back(
          {output.name.text, findColumnSpec(spec, output.name.text), findOutputUnit(output, model.system)});
    }
  }
  return question;
}

NoiseQuestion askForColumns(const std::vector<std::string>& wanted) {
  NoiseQuestion question;
  for (const std::string& text : wanted) {
    const ColumnSpec column = parseColumn(text, {"--columns", 0, 0, ""});
    question.columns.push_back({column.name, column, ""});
  }
  return question;
}

std::vector<std::string> listNeeded(const NoiseQuestion& question) {
  std::vector<std::string> names;
  for (const NoiseColumn& column : question.columns) {
    names.push_back(column.column.name);
  }
  if (!names.empty()) {
    const std::vector<std::string> times = listTimeColumns(question.base);
    names.insert(names.end(), times.begin(), times.end());
  }
  return names;
}

ExperimentSpec loadOneTrial(const std::string& file) {
  ExperimentSpec experiment = loadExperiment(file);
  requireOneTrial(experiment, "a recording is of one");
  return experiment;
}

}  // namespace

void noise(const NoiseArguments& arguments) {
  NoiseQuestion question = arguments.experiment.empty()
                               ? askForColumns(arguments.columns)
                               : askForOutputs(loadOneTrial(arguments.experiment), arguments.columns);
  if (!arguments.window.empty()) {
    question.window = {arguments.window[0], arguments.window[1]};
  }
  const Table table = readTable(arguments.measurement, listNeeded(question), MissingCells::kKeep);
  const std::vector<SignalNoise> signals = estimateNoise(table, question);
  std::cout << (arguments.json ? makeNoiseJson(signals, table.source)
                               : makeNoiseTable(signals) + "\n" + makeNoiseYaml(signals));
}

}  // namespace twinmap::cli
