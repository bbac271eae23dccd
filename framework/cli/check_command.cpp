#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/spec/experiment_file.hpp"
#include "framework/spec/sweep_cases.hpp"

namespace twinmap {

void check(const ExperimentArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.file, arguments.overrides);
  expandCases(tree);  // finds what is wrong in any of them
  std::cout << (tree.find("sweep") == nullptr ? writeExperiment(readExperiment(tree))
                                              : writeIndependentDefaults(tree));
}

}  // namespace twinmap
