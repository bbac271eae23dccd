#include "framework/optimal_design/verify_design.hpp"

#include "framework/base/files/atomic_file.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/results/comparison_text.hpp"
#include "framework/study/pipeline/run_experiment.hpp"

namespace twinmap::experiment_design {
namespace {

namespace fs = std::filesystem;

ComparedRun run(const YamlNode& tree, const fs::path& folder, const RunControl& control) {
  ExperimentSpec experiment = readExperimentWithSignals(tree);
  if (experiment.design.train.samples.automatic) {
    experiment = takeTrainingSamples(experiment, experiment.design.train.samples);
  }
  RunOptions options;
  options.folder = folder;
  options.command = "twinmap design --verify";
  runExperiment(experiment, options, control);
  return readComparedRun(folder);
}

}  // namespace

std::string verifyDesign(const YamlNode& tree, const fs::path& folder, const RunControl& control) {
  const fs::path verify = folder / "verify";
  const ComparedRun before = run(tree, verify / "before", control);
  const ComparedRun after = run(loadYaml((folder / "designed.yaml").string()), verify / "after", control);
  const std::string text = makeComparisonText(compareRuns(before, after));
  writeTextFile(verify / "comparison.txt", text);
  return text;
}

}  // namespace twinmap::experiment_design
