#include "framework/cli/commands/measurements/replay_measurement.hpp"

#include <stdexcept>

#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/inference/known_value.hpp"

namespace twinmap::cli {
namespace {

double findStart(const MeasurementReader& reader, const std::string& file, std::optional<double> start) {
  return start || !reader.getExperiment().measurement.start.when
             ? reader.getStatedStart(start)
             : reader.getStart(readTable(file, reader.listColumns()), start);
}

ReplayOptions chooseOptions(const ReplayArguments& arguments, const InferenceSource& source) {
  const ExperimentSpec& experiment = source.getExperiment();
  ReplayOptions options;
  options.measurement = {arguments.file, findStart(source.getReader(), arguments.file, arguments.start)};
  options.from = options.measurement;
  if (!arguments.from.empty()) {
    options.from = {arguments.from, findStart(source.getReader(), arguments.from, arguments.from_start)};
  }
  options.from.start = arguments.from_start.value_or(options.from.start);
  options.known = collectKnown(experiment.model.inputs, parseKnownValues(arguments.known));
  options.refine = arguments.refine;
  options.draws = arguments.draws;
  options.threads = arguments.threads;
  return options;
}

Replay replayWith(const InferenceSource& source, const ReplayOptions& options) {
  try {
    return twinmap::replay(source, options);
  } catch (const MeasurementError& error) {
    throw std::runtime_error(error.what());
  }
}

/// Of the measurement that parameters are inferred from.
Asked describeAsked(const ReplayArguments& arguments) {
  const bool same = arguments.from.empty();
  const std::optional<double>& start = same ? arguments.start : arguments.from_start;
  Asked asked{arguments.run, {same ? arguments.file : arguments.from}, {}, arguments.known};
  if (start) {
    asked.starts.push_back(*start);
  }
  return asked;
}

/// Asks what the model lacks.
void testModel(const InferenceSource& source, Replay& replay) {
  const MeasurementReader& reader = source.getReader();
  const MeasuredWindow& from = replay.options.from;
  const Table table = readTable(from.file.string(), reader.listColumns(), MissingCells::kKeep);
  twinmap::testModel(reader, table, from.start, replay.options.known, replay.inferred);
}

}  // namespace

Replay replayMeasurement(const InferenceSource& source, const ReplayArguments& arguments) {
  Replay replay = replayWith(source, chooseOptions(arguments, source));
  replay.inferred.asked = describeAsked(arguments);
  testModel(source, replay);
  return replay;
}

}  // namespace twinmap::cli
