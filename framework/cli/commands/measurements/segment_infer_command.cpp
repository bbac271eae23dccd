#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/experiment_of_run.hpp"
#include "framework/cli/commands/measurements/inferred_printer.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/experiment/trials/trial_trees.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/segments/segment_inference.hpp"

namespace twinmap::cli {
namespace {

void requireSegmentArguments(const InferArguments& arguments) {
  if (!arguments.trials.empty() || arguments.joint || arguments.windows) {
    throw ExperimentError("--segments infers each file by itself; leave --joint, --trial and --windows out");
  }
  if (arguments.follow || arguments.files.empty()) {
    throw ExperimentError("--segments cuts recordings in files; give files of measurements");
  }
  if (arguments.refine || !arguments.posterior_from.empty()) {
    throw ExperimentError(
        "segments are inferred by simulation alone; leave --refine, --no-refine and --posterior-from out");
  }
  if (!arguments.page.empty() || !arguments.draws.empty() || arguments.diagnose) {
    throw ExperimentError(
        "--page, --draws and --diagnose are not for segments; leave them or --segments out");
  }
}

ExperimentSpec loadWithoutTrials(const std::string& file) {
  const YamlNode tree = selectTrial(loadExperimentTree(file));
  if (hasTrials(tree)) {
    throw ExperimentError("segments are of a recording of one experiment, and this one has trials: " +
                          describeOwnFile());
  }
  return readExperiment(tree);
}

}  // namespace

void inferInSegments(const InferArguments& arguments) {
  requireSegmentArguments(arguments);
  ExperimentSpec experiment = loadWithoutTrials(findExperimentFile(arguments.run));
  const Eigen::VectorXd known = collectKnown(experiment.model.inputs, parseKnownValues(arguments.known));
  const int draws =
      arguments.posterior_draws > 0 ? arguments.posterior_draws : SegmentInference::kDefaultDraws;
  const SegmentInference inference(std::move(experiment), *arguments.segments, known, draws);
  std::vector<std::optional<double>> starts(arguments.starts.begin(), arguments.starts.end());
  if (starts.empty()) {
    starts.emplace_back(std::nullopt);
  }
  const InferredPrinter printer(chooseFormat(arguments), inference.getExperiment().model.parameters, false,
                                false);
  printer.printHeader();
  bool is_first = true;
  for (const std::string& file : arguments.files) {
    const Table table = readTable(file, inference.listColumns(), MissingCells::kKeep);
    for (const std::optional<double>& start : starts) {
      WaitingLine waiting("infer " + nameWindow(file, start) + " in segments");
      InferredMeasurement inferred = inference.infer(table, start);
      inferred.asked = {arguments.run, {file}, {}, arguments.known, {}, draws};
      if (start) {
        inferred.asked.starts.push_back(*start);
      }
      waiting.clear();
      printer.print(inferred, inferred.segments->samples, is_first);
      is_first = false;
    }
  }
}

}  // namespace twinmap::cli
