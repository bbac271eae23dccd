
#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/progress_line.hpp"
#include "framework/cli/signals.hpp"
#include "framework/experiment/check/uniform_priors.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/optimal_design/excitation.hpp"
#include "framework/optimal_design/excitation_files.hpp"
#include "framework/optimal_design/sensor_files.hpp"
#include "framework/optimal_design/sensors.hpp"
#include "framework/optimal_design/verify_design.hpp"

namespace twinmap::cli {

namespace {

namespace fs = std::filesystem;
using experiment_design::verifyDesign;

/// Designs something in a folder; returns what to tell about it.
struct Designed {
  std::string text;
  std::vector<std::string> warnings;
};

/// Runs a design with progress, prints what it tells, and verifies it where that is asked for.
template <class Design>
void runDesign(const DesignArguments& arguments, const Design& design) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  const ExperimentSpec experiment = readExperiment(tree);
  requireUniformPriors(experiment.model, "has a prior, which designs do not know yet: leave it out");
  const fs::path folder = arguments.folder.empty() ? fs::path("results/" + experiment.name.text + "_design")
                                                   : fs::path(arguments.folder);
  showWarningsOnly();
  ProgressLine line;
  const StopFlags flags = catchSignals();
  const RunControl control{arguments.threads, &flags.stop, &flags.abandon,
                           [&line](const Progress& progress) { line.update(progress); }};
  const Designed designed = design(tree, folder, control);
  line.clear();
  std::cout << designed.text;
  for (const std::string& warning : designed.warnings) {
    std::cerr << "twinmap: warning: " << warning << "\n";
  }
  if (arguments.verify) {
    std::cout << "\n" << verifyDesign(tree, folder, control);
    line.clear();
  }
  std::cerr << "Designed experiment: " << (folder / "designed.yaml").string() << "\n";
}

}  // namespace

void designExcitation(const DesignArguments& arguments) {
  try {
    runDesign(arguments, [](const YamlNode& tree, const fs::path& folder, const RunControl& control) {
      const auto design = experiment_design::designExcitation(tree, folder, control);
      return Designed{experiment_design::describeDesign(design), design.warnings};
    });
  } catch (const Interrupted& interrupted) {
    throw Interrupted(std::string(interrupted.what()) + "; the same command continues:\n  " +
                      arguments.command_line);
  }
}

void designSensors(const DesignArguments& arguments) {
  runDesign(arguments, [](const YamlNode& tree, const fs::path& folder, const RunControl& control) {
    const auto design = experiment_design::designSensors(tree, folder, control);
    return Designed{experiment_design::describeSensors(design), design.warnings};
  });
}

}  // namespace twinmap::cli
