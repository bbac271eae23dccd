#include <fmt/core.h>

#include <algorithm>
#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/experiment_of_run.hpp"
#include "framework/cli/commands/measurements/infer_options.hpp"
#include "framework/cli/commands/measurements/inferred_printer.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/trial_trees.hpp"
#include "framework/inference/joint/recording_list.hpp"
#include "framework/inference/joint/trial_reader.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement/direct_inference.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/inference/measurement/measurement_inference.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap::cli {
namespace {

bool isTrained(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? std::filesystem::exists(run / "maps.h5")
                                            : run.extension() == ".h5";
}

/// Whether each of the run's trials has one of the files, as far as the experiment beside the map says: a map
/// takes longer to load.
bool mayHaveAll(const InferArguments& arguments, const std::vector<TrialFile>& files) {
  if (!std::filesystem::is_directory(arguments.run)) {
    return true;
  }
  const std::vector<Trial> trials = expandTrials(loadExperimentTree(findExperimentFile(arguments.run)));
  return std::all_of(trials.begin(), trials.end(), [&](const Trial& trial) {
    return trial.name.empty() || std::count_if(files.begin(), files.end(), [&](const TrialFile& one) {
                                   return one.trial == trial.name;
                                 }) == 1;
  });
}

void logMissing() {
  logInfo("the estimator of the run needs one whole recording of each trial; inferring by simulation");
}

/// As --json or --csv ask for it, or as a table.
void printInferred(const InferArguments& arguments, const InferredMeasurement& inferred,
                   const MeasurementReader& reader, const MeasurementInference& session) {
  const InferredPrinter printer(chooseFormat(arguments), reader.getExperiment().model.parameters,
                                session.refines(), session.samplesPosteriors());
  printer.printHeader();
  printer.print(inferred, reader.getExtractor().getInfos(), true);
}

/// The values of --set, for all inputs of the experiment.
Eigen::VectorXd readKnown(const InferArguments& arguments, const MeasurementReader& reader) {
  return collectKnown(reader.getExperiment().model.inputs, parseKnownValues(arguments.known));
}

/// Recordings by the estimator that a run trained on all trials together. False where there is none, or it
/// needs more than these recordings have.
bool inferTrialsByRun(const InferArguments& arguments) {
  if (arguments.trials.empty() || arguments.joint || arguments.windows || arguments.starts.size() > 1 ||
      !isTrained(arguments.run)) {
    return false;
  }
  const std::vector<TrialFile> files = parseTrialFiles(arguments.trials);
  if (!mayHaveAll(arguments, files)) {
    logMissing();
    return false;
  }
  const InferenceSource source(arguments.run);
  const TrialReader trials(source.getExperiment());
  std::vector<RecordedTable> tables;
  std::string names;
  for (const TrialFile& one : files) {
    tables.push_back(
        {one.trial, one.file, readTable(one.file, trials.get(one.trial).listColumns(), MissingCells::kKeep)});
    names += (names.empty() ? "" : ", ") + one.trial + "=" + one.file;
  }
  const std::optional<double> start =
      arguments.starts.empty() ? std::nullopt : std::optional<double>(arguments.starts.front());
  const std::optional<Eigen::VectorXd> features = trials.read(tables, start);
  if (!features) {
    logMissing();
    return false;
  }
  const std::unique_ptr<MeasurementInference> session = source.makeSession(makeSessionOptions(arguments));
  WaitingLine waiting("infer " + names);
  InferredMeasurement inferred = session->infer(*features, readKnown(arguments, source.getReader()));
  waiting.clear();
  inferred.source = names;
  inferred.asked = {
      arguments.run, {}, arguments.trials, arguments.known, arguments.starts, arguments.posterior_draws};
  printInferred(arguments, inferred, source.getReader(), *session);
  return true;
}

std::vector<TrialFile> listFiles(const InferArguments& arguments, const JointInferrer& inferrer) {
  std::vector<TrialFile> files = parseTrialFiles(arguments.trials);
  for (const TrialFile& one : files) {
    inferrer.getReader(one.trial);
  }
  for (const std::string& file : arguments.files) {
    if (inferrer.listTrials().size() > 1) {
      throw ExperimentError(file + ": which trial does it record? Give --trial NAME=" + file);
    }
    files.push_back({inferrer.listTrials().front(), file});
  }
  return files;
}

std::vector<RecordedTable> readTables(const InferArguments& arguments, const JointInferrer& inferrer) {
  std::vector<RecordedTable> tables;
  for (const TrialFile& one : listFiles(arguments, inferrer)) {
    const std::vector<std::string> columns = inferrer.getReader(one.trial).listColumns();
    tables.push_back({one.trial, one.file, readTable(one.file, columns, MissingCells::kKeep)});
  }
  return tables;
}

Asked describeAsked(const InferArguments& arguments) {
  return {arguments.run,   arguments.files,  arguments.trials,
          arguments.known, arguments.starts, arguments.posterior_draws};
}

/// With the windows, if they are of one file: others may be shorter.
Asked describeAsked(const InferArguments& arguments, const std::vector<Recording>& recordings) {
  Asked asked = describeAsked(arguments);
  if (arguments.windows && arguments.files.size() + arguments.trials.size() == 1) {
    asked.starts.clear();
    for (const Recording& one : recordings) {
      asked.starts.push_back(*one.start);
    }
  }
  return asked;
}

void requireJointArguments(const InferArguments& arguments) {
  if (arguments.follow) {
    throw ExperimentError(
        "--follow infers one measurement after another; leave --joint, --trial and --windows out");
  }
  if (arguments.diagnose) {
    throw ExperimentError("--diagnose is of one measurement; of several: twinmap diagnose " +
                          listArguments(describeAsked(arguments)));
  }
  if (!arguments.page.empty()) {
    throw ExperimentError(
        "--page draws estimates of one measurement after another; leave --joint, --trial and --windows out");
  }
  if (!arguments.draws.empty()) {
    throw ExperimentError("--draws are of one measurement; leave it out, or --joint, --trial and --windows");
  }
}

std::optional<int> findDraws(const InferArguments& arguments) {
  return arguments.posterior_draws > 0 ? std::optional<int>(arguments.posterior_draws) : std::nullopt;
}

/// The only recording of a trial: as its own experiment file would infer it.
void inferTrial(const InferArguments& arguments, const MeasurementReader& reader,
                const Recording& recording) {
  DirectInference session(reader, findDraws(arguments).value_or(SimulatorPosteriorOptions{}.draws));
  const Eigen::VectorXd known = readKnown(arguments, reader);
  const std::string window = nameWindow(recording.table->source, recording.start);
  WaitingLine waiting("infer " + window);
  InferredMeasurement inferred = session.infer(*recording.table, recording.start, known);
  inferred.asked = describeAsked(arguments);
  waiting.describe("look for what the model lacks, " + window,
                   [&, answer = inferred] { printInferred(arguments, answer, reader, session); });
  testModel(reader, *recording.table, recording.start, known, inferred);
  waiting.clear();
  printInferred(arguments, inferred, reader, session);
}

void printJoint(const InferArguments& arguments, const JointInference& inferred,
                const std::vector<ParameterSpec>& parameters) {
  if (arguments.json) {
    std::cout << makeJointJson(inferred, parameters) << "\n";
  } else if (arguments.csv) {
    std::cout << makeInferenceCsvHeader(false, false) << makeJointCsvRows(inferred, parameters);
  } else {
    std::cout << makeJointTable(inferred, parameters);
  }
}

}  // namespace

void inferJointly(const InferArguments& arguments) {
  requireJointArguments(arguments);
  if (inferTrialsByRun(arguments)) {
    return;
  }
  if (arguments.refine) {
    throw ExperimentError(
        "several recordings are inferred by simulation alone: there is nothing to refine; leave --refine and "
        "--no-refine out");
  }
  const JointInferrer inferrer(loadExperimentTree(findExperimentFile(arguments.run)), arguments.known,
                               findDraws(arguments));
  const RecordingList recordings(inferrer, readTables(arguments, inferrer),
                                 {arguments.starts, arguments.windows});
  if (recordings.get().size() == 1 && !arguments.trials.empty()) {
    const Recording& only = recordings.get().front();
    inferTrial(arguments, inferrer.getReader(only.trial), only);
    return;
  }
  if (recordings.get().size() < 2) {
    throw ExperimentError(
        "one recording alone is not inferred jointly; give several files, starts or windows");
  }
  WaitingLine waiting(fmt::format("infer from {} recordings", recordings.get().size()));
  JointInference inferred = inferrer.infer(recordings.get());
  inferred.asked = describeAsked(arguments, recordings.get());
  waiting.describe("look for what the model lacks",
                   [&, answer = inferred] { printJoint(arguments, answer, inferrer.getParameters()); });
  testModel(findExperimentFile(arguments.run), recordings.get(), arguments.known, inferred);
  waiting.clear();
  printJoint(arguments, inferred, inferrer.getParameters());
}

}  // namespace twinmap::cli
