#include <fmt/format.h>

#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/diagnosis/diagnosis_text.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/inference/inference_source.hpp"
#include "framework/inference/measurement/known_value.hpp"
#include "framework/study/diagnosis/diagnosis_page.hpp"

namespace twinmap::cli {
namespace {

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

/// Tolerances that the file does not give follow the noise anew: the terms' parameters may need smaller ones.
void freeTolerances(SimulationSpec& simulation) {
  const SimulationSpec defaults;
  if (simulation.relative_tolerance.where.line == 0) {
    simulation.relative_tolerance = defaults.relative_tolerance;
  }
  if (simulation.absolute_tolerance.where.line == 0) {
    simulation.absolute_tolerance = defaults.absolute_tolerance;
  }
}

}  // namespace

void diagnose(const DiagnoseArguments& arguments) {
  const InferenceSource source(arguments.run);
  const MeasurementReader& reader = source.getReader();
  const RecordedFeatures recordings =
      readRecordings(reader, arguments.files, arguments.starts, parseKnownValues(arguments.known));
  if (arguments.files.empty()) {
    if (!arguments.accepted.empty()) {
      throw ExperimentError("--accept fits a term to measurements; give their files");
    }
    if (!arguments.page.empty()) {
      throw ExperimentError("--page draws measurements; give their files");
    }
    printBlindSpots(arguments, reader, recordings);
    return;
  }
  DiagnosisOptions options;
  options.accepted = arguments.accepted;
  options.posterior = makePosteriorOptions(reader.getExperiment(), SimulatorPosteriorOptions{}.draws);
  Diagnosis diagnosis = twinmap::diagnose(reader.getExperiment(), recordings, options);
  const std::string name = fmt::format("{}", fmt::join(arguments.files, ", "));
  std::cout << (arguments.json  ? makeDiagnosisJson(diagnosis, name) + "\n"
                : arguments.csv ? makeDiagnosisCsv(diagnosis, name)
                                : makeDiagnosisTable(diagnosis, name));
  if (!arguments.out.empty()) {
    freeTolerances(diagnosis.corrected.model.simulation);
    writeTextFile(arguments.out, writeExperiment(diagnosis.corrected));
  }
  if (!arguments.page.empty()) {
    writeTextFile(arguments.page, makeDiagnosisPage(diagnosis, reader.getExperiment(), recordings,
                                                    nameRecordings(arguments.files, arguments.starts)));
  }
}

}  // namespace twinmap::cli
