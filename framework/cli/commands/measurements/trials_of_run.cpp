#include "framework/cli/commands/measurements/trials_of_run.hpp"

#include <algorithm>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/measurements/experiment_of_run.hpp"
#include "framework/cli/commands/measurements/infer_options.hpp"
#include "framework/cli/commands/measurements/inferred_printer.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/trial_trees.hpp"
#include "framework/inference/joint/recording_list.hpp"
#include "framework/inference/joint/trial_reader.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement/inference_source.hpp"

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

}  // namespace

void printInferred(const InferArguments& arguments, const InferredMeasurement& inferred,
                   const MeasurementReader& reader, const MeasurementInference& session) {
  const InferredPrinter printer(chooseFormat(arguments), reader.getExperiment().model.parameters,
                                session.refines(), session.samplesPosteriors());
  printer.printHeader();
  printer.print(inferred, reader.getExtractor().getInfos(), true);
}

Eigen::VectorXd readKnown(const InferArguments& arguments, const MeasurementReader& reader) {
  return collectKnown(reader.getExperiment().model.inputs, parseKnownValues(arguments.known));
}

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

}  // namespace twinmap::cli
