#include <fmt/core.h>

#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/experiment_of_run.hpp"
#include "framework/cli/commands/measurements/infer_options.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/inference/direct_inference.hpp"
#include "framework/inference/inference_source.hpp"
#include "framework/inference/measurement/known_value.hpp"
#include "framework/inference/recording_list.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/inference/trial_reader.hpp"

namespace twinmap::cli {
namespace {

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

void requireJointArguments(const InferArguments& arguments) {
  if (arguments.follow) {
    throw ExperimentError(
        "--follow infers one measurement after another; leave --joint, --trial and --windows out");
  }
  if (!arguments.page.empty()) {
    throw ExperimentError(
        "--page draws estimates of one measurement after another; leave --joint, --trial and --windows out");
  }
  if (!arguments.draws.empty()) {
    throw ExperimentError("--draws are of one measurement; leave it out, or --joint, --trial and --windows");
  }
}

void print(const InferArguments& arguments, const InferredMeasurement& inferred,
           const MeasurementReader& reader, const MeasurementInference& session) {
  const std::vector<ParameterSpec>& parameters = reader.getExperiment().model.parameters;
  const std::vector<FeatureInfo>& features = reader.getExtractor().getInfos();
  if (arguments.json) {
    std::cout << makeInferenceJson(inferred, parameters, features) << "\n";
  } else if (arguments.csv) {
    std::cout << makeInferenceCsvHeader(session.refines(), session.samplesPosteriors())
              << makeInferenceCsvRows(inferred, parameters, session.samplesPosteriors());
  } else {
    std::cout << makeInferenceTable(inferred, parameters, features);
  }
}

Eigen::VectorXd readKnown(const InferArguments& arguments, const MeasurementReader& reader) {
  return collectKnown(reader.getExperiment().model.inputs, parseKnownValues(arguments.known));
}

/// The only recording of a trial: as its own experiment file would infer it.
void inferTrial(const InferArguments& arguments, const MeasurementReader& reader, const Recording& recording,
                int draws) {
  DirectInference session(reader, draws);
  print(arguments, session.infer(*recording.table, recording.start, readKnown(arguments, reader)), reader,
        session);
}

bool isTrained(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? std::filesystem::exists(run / "maps.h5")
                                            : run.extension() == ".h5";
}

/// By the estimator that a run trained on all trials together. False where there is none, or it needs more
/// than these recordings have.
bool inferByRun(const InferArguments& arguments) {
  if (arguments.trials.empty() || arguments.joint || arguments.windows || arguments.starts.size() > 1 ||
      !isTrained(arguments.run)) {
    return false;
  }
  const InferenceSource source(arguments.run);
  const TrialReader trials(source.getExperiment());
  std::vector<RecordedTable> tables;
  std::string names;
  for (const TrialFile& one : parseTrialFiles(arguments.trials)) {
    tables.push_back(
        {one.trial, one.file, readTable(one.file, trials.get(one.trial).listColumns(), MissingCells::kKeep)});
    names += (names.empty() ? "" : ", ") + one.trial + "=" + one.file;
  }
  const std::optional<double> start =
      arguments.starts.empty() ? std::nullopt : std::optional<double>(arguments.starts.front());
  const std::optional<Eigen::VectorXd> features = trials.read(tables, start);
  if (!features) {
    logInfo("the estimator of the run needs one whole recording of each trial; inferring by simulation");
    return false;
  }
  const std::unique_ptr<MeasurementInference> session = source.makeSession(makeSessionOptions(arguments));
  WaitingLine waiting("inferring " + names);
  InferredMeasurement inferred = session->infer(*features, readKnown(arguments, source.getReader()));
  waiting.clear();
  inferred.source = names;
  inferred.run = arguments.run;
  print(arguments, inferred, source.getReader(), *session);
  return true;
}

}  // namespace

void inferJointly(const InferArguments& arguments) {
  requireJointArguments(arguments);
  if (inferByRun(arguments)) {
    return;
  }
  if (arguments.refine) {
    throw ExperimentError(
        "several recordings are inferred by simulation alone: there is nothing to refine; leave --refine and "
        "--no-refine out");
  }
  const int draws =
      arguments.posterior_draws > 0 ? arguments.posterior_draws : SimulatorPosteriorOptions{}.draws;
  const JointInferrer inferrer(loadExperimentTree(findExperimentFile(arguments.run)), arguments.known, draws);
  const RecordingList recordings(inferrer, readTables(arguments, inferrer),
                                 {arguments.starts, arguments.windows});
  if (recordings.get().size() == 1 && !arguments.trials.empty()) {
    const Recording& only = recordings.get().front();
    inferTrial(arguments, inferrer.getReader(only.trial), only, draws);
    return;
  }
  if (recordings.get().size() < 2) {
    throw ExperimentError(
        "one recording alone is not inferred jointly; give several files, starts or windows");
  }
  WaitingLine waiting(fmt::format("inferring from {} recordings", recordings.get().size()));
  const JointInference inferred = inferrer.infer(recordings.get());
  waiting.clear();
  if (arguments.json) {
    std::cout << makeJointJson(inferred, inferrer.getParameters()) << "\n";
  } else if (arguments.csv) {
    std::cout << makeInferenceCsvHeader(false, false) << makeJointCsvRows(inferred, inferrer.getParameters());
  } else {
    std::cout << makeJointTable(inferred, inferrer.getParameters());
  }
}

}  // namespace twinmap::cli
