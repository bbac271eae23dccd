#include <fmt/format.h>

#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/experiment_of_run.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/problem/sensor_faults.hpp"
#include "framework/diagnosis/text/corrected_file.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/joint/recording_list.hpp"
#include "framework/inference/joint/trial_reader.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/models/model_remarks.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/study/diagnosis/diagnosis_page.hpp"

namespace twinmap::cli {
namespace {

void printBlindSpots(const DiagnoseArguments& arguments, const ExperimentSpec& experiment,
                     WaitingLine& waiting) {
  const RecordedFeatures none = makeEmptyRecordings(experiment, parseKnownValues(arguments.known));
  const std::vector<BlindSpot> spots = calcBlindSpots(experiment, none, DiagnosisOptions{}.level);
  waiting.clear();
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  std::cout << (arguments.json  ? makeBlindSpotJson(spots, parameters) + "\n"
                : arguments.csv ? makeBlindSpotCsv(spots, parameters)
                                : makeBlindSpotTable(spots, parameters));
}

void requireMeasurements(const DiagnoseArguments& arguments) {
  if (!arguments.accepted.empty()) {
    throw ExperimentError("--accept fits a term to measurements; give their files");
  }
  if (!arguments.page.empty()) {
    throw ExperimentError("--page draws measurements; give their files");
  }
}

void requireTrials(const DiagnoseArguments& arguments, const ExperimentSpec& experiment) {
  if (!experiment.trials.empty() && !arguments.files.empty()) {
    throw ExperimentError(arguments.files.front() +
                          ": which trial does it record? Give --trial NAME=" + arguments.files.front());
  }
  if (!arguments.trials.empty() && experiment.trials.empty()) {
    throw ExperimentError("--trial " + arguments.trials.front() +
                          ": the experiment has no trials; give the file alone");
  }
  if (!arguments.trials.empty() && !arguments.page.empty()) {
    throw ExperimentError("--page draws recordings of one trial: " + describeOwnFile() +
                          ", and diagnose that with its recordings and --page");
  }
}

std::vector<RecordedTable> readTables(const DiagnoseArguments& arguments, const JointInferrer& inferrer) {
  std::vector<TrialFile> files = parseTrialFiles(arguments.trials);
  for (const std::string& file : arguments.files) {
    files.push_back({"", file});
  }
  std::vector<RecordedTable> tables;
  for (const TrialFile& one : files) {
    const std::vector<std::string> columns = inferrer.getReader(one.trial).listColumns();
    tables.push_back({one.trial, one.file, readTable(one.file, columns, MissingCells::kKeep)});
  }
  return tables;
}

}  // namespace

void diagnose(const DiagnoseArguments& arguments) {
  setThreads(arguments.threads);
  const std::string name =
      fmt::format("{}", fmt::join(arguments.trials.empty() ? arguments.files : arguments.trials, ", "));
  WaitingLine waiting("diagnose " + (name.empty() ? arguments.run : name));
  const InferenceSource source = arguments.trials.empty() ? InferenceSource(arguments.run)
                                                          : readAllTrials(findExperimentFile(arguments.run));
  const MeasurementReader& reader = source.getReader();
  if (arguments.files.empty() && arguments.trials.empty()) {
    requireMeasurements(arguments);
    printBlindSpots(arguments, reader.getExperiment(), waiting);
    return;
  }
  const ExperimentSpec& experiment = reader.getExperiment();
  requireTrials(arguments, experiment);
  const std::vector<KnownValue> known = parseKnownValues(arguments.known);
  const JointInferrer inferrer(experiment, known);
  const RecordingList list(inferrer, readTables(arguments, inferrer), {arguments.starts, {}});
  const DiagnosedRecordings recordings = explainSensors(inferrer, experiment, list.get(), known);
  DiagnosisOptions options;
  options.accepted = arguments.accepted;
  options.candidates.only = arguments.only;
  options.candidates.without = arguments.without;
  options.posterior = makePosteriorOptions(experiment, SimulatorPosteriorOptions{}.draws);
  const Diagnosis diagnosis = diagnoseExplained(experiment, recordings, options);
  waiting.clear();
  if (!diagnosis.before.isExplained()) {
    for (const std::string& against : listModelRemarks(experiment.model)) {
      std::cerr << "twinmap: " << against << "\n";
    }
  }
  std::cout << (arguments.json  ? makeDiagnosisJson(diagnosis, name) + "\n"
                : arguments.csv ? makeDiagnosisCsv(diagnosis, name)
                                : makeDiagnosisTable(diagnosis, name));
  if (!arguments.out.empty()) {
    writeTextFile(arguments.out, writeCorrected(diagnosis.corrected));
  }
  if (!arguments.page.empty()) {
    writeTextFile(arguments.page, makeDiagnosisPage(diagnosis, experiment, recordings.features,
                                                    nameRecordings(arguments.files, arguments.starts)));
  }
}

}  // namespace twinmap::cli
