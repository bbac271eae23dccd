#include <spdlog/spdlog.h>

#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/cli/log.hpp"
#include "framework/cli/progress_line.hpp"
#include "framework/cli/signals.hpp"
#include "framework/experiment_design/excitation.hpp"
#include "framework/experiment_design/excitation_files.hpp"
#include "framework/experiment_design/verify_design.hpp"
#include "framework/monitoring/interrupted.hpp"
#include "framework/spec/experiment_file.hpp"

namespace twinmap::cli {

void designExcitation(const DesignArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  const std::filesystem::path folder =
      arguments.folder.empty() ? "results/" + readExperiment(tree).name.text + "_design" : arguments.folder;
  showWarningsOnly();
  ProgressLine line;
  const StopFlags flags = catchSignals();
  const RunControl control{arguments.threads, &flags.stop, &flags.abandon,
                           [&line](const Progress& progress) { line.update(progress); }};
  try {
    const experiment_design::ExcitationDesign design =
        experiment_design::designExcitation(tree, folder, control);
    line.clear();
    std::cout << experiment_design::describeDesign(design);
    for (const std::string& warning : design.warnings) {
      std::cerr << "twinmap: warning: " << warning << "\n";
    }
    if (arguments.verify) {
      std::cout << "\n" << experiment_design::verifyDesign(tree, folder, control);
      line.clear();
    }
    std::cerr << "Designed experiment: " << (folder / "designed.yaml").string() << "\n";
  } catch (const Interrupted& interrupted) {
    throw Interrupted(std::string(interrupted.what()) + "; the same command continues:\n  " +
                      arguments.command_line);
  }
}

}  // namespace twinmap::cli
