#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/measurement/signal_experiment.hpp"
#include "framework/spec/experiment_file.hpp"

namespace twinmap::cli {

void check(const ExperimentArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.file, arguments.overrides);
  expandCasesWithSignals(tree);  // finds what is wrong in any of them
  std::cout << (tree.find("sweep") == nullptr ? writeExperiment(readExperimentWithSignals(tree))
                                              : writeIndependentDefaults(tree));
}

}  // namespace twinmap::cli
