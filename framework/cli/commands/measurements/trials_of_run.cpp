#include "framework/cli/commands/measurements/trials_of_run.hpp"

#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/measurements/infer_options.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/inference/inference_source.hpp"
#include "framework/inference/measurement/known_value.hpp"
#include "framework/inference/recording_list.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/inference/trial_reader.hpp"

namespace twinmap::cli {
namespace {

bool isTrained(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? std::filesystem::exists(run / "maps.h5")
                                            : run.extension() == ".h5";
}

}  // namespace

void printInferred(const InferArguments& arguments, const InferredMeasurement& inferred,
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

bool inferTrialsByRun(const InferArguments& arguments) {
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
  printInferred(arguments, inferred, source.getReader(), *session);
  return true;
}

}  // namespace twinmap::cli
