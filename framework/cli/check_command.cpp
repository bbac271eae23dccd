#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/spec/experiment_file.hpp"

namespace twinmap {

void check(const ExperimentArguments& arguments) {
  std::cout << writeExperiment(loadExperiment(arguments.file, arguments.overrides));
}

}  // namespace twinmap
