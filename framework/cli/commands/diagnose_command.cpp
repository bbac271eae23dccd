#include <fmt/format.h>

#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/diagnosis/diagnosis_text.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/inference/inference_source.hpp"
#include "framework/inference/measurement/known_value.hpp"

namespace twinmap::cli {
namespace {

RecordedFeatures readRecordings(const DiagnoseArguments& arguments, const MeasurementReader& reader) {
  RecordedFeatures recordings{reader.getLayout(), {}, {}};
  recordings.known = collectKnown(reader.getExperiment().model.inputs, parseKnownValues(arguments.known));
  std::vector<std::optional<double>> starts(arguments.starts.begin(), arguments.starts.end());
  if (starts.empty()) {
    starts.emplace_back(std::nullopt);
  }
  for (const std::string& file : arguments.files) {
    const Table table = readTable(file, reader.listColumns(), MissingCells::kKeep);
    for (const std::optional<double>& start : starts) {
      AvailableFeatures found = reader.readAvailableFeatures(table, start);
      requireStatedNoise(found.stddev, table.source);
      recordings.features.push_back(std::move(found.features));
    }
  }
  return recordings;
}

void printBlindSpots(const DiagnoseArguments& arguments, const MeasurementReader& reader,
                     RecordedFeatures recordings) {
  const ExperimentSpec& experiment = reader.getExperiment();
  recordings.features = {Eigen::VectorXd::Zero(reader.getExtractor().getFeatureCount())};
  const std::vector<BlindSpot> spots = calcBlindSpots(experiment, recordings, DiagnosisOptions{}.level);
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  std::cout << (arguments.json  ? makeBlindSpotJson(spots, parameters) + "\n"
                : arguments.csv ? makeBlindSpotCsv(spots, parameters)
                                : makeBlindSpotTable(spots, parameters));
}

}  // namespace

void diagnose(const DiagnoseArguments& arguments) {
  const InferenceSource source(arguments.run);
  const MeasurementReader& reader = source.getReader();
  const RecordedFeatures recordings = readRecordings(arguments, reader);
  if (arguments.files.empty()) {
    if (!arguments.accepted.empty()) {
      throw ExperimentError("--accept fits a term to measurements; give their files");
    }
    printBlindSpots(arguments, reader, recordings);
    return;
  }
  DiagnosisOptions options;
  options.accepted = arguments.accepted;
  options.posterior = makePosteriorOptions(reader.getExperiment(), SimulatorPosteriorOptions{}.draws);
  const Diagnosis diagnosis = twinmap::diagnose(reader.getExperiment(), recordings, options);
  const std::string name = fmt::format("{}", fmt::join(arguments.files, ", "));
  std::cout << (arguments.json  ? makeDiagnosisJson(diagnosis, name) + "\n"
                : arguments.csv ? makeDiagnosisCsv(diagnosis, name)
                                : makeDiagnosisTable(diagnosis, name));
  if (!arguments.out.empty()) {
    writeTextFile(arguments.out, writeExperiment(diagnosis.corrected));
  }
}

}  // namespace twinmap::cli
