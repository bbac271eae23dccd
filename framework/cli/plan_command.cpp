#include <spdlog/spdlog.h>

#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/spec/experiment_file.hpp"
#include "framework/sweep/plan.hpp"

namespace twinmap::cli {

void plan(const RunArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  PlanOptions options;
  options.folder = chooseFolder(arguments, readExperiment(tree));
  options.store = arguments.store;
  options.threads = arguments.threads;
  options.memory = chooseMemory(arguments);
  spdlog::set_level(spdlog::level::off);  // of the small runs that are timed
  std::cout << describePlan(planRun(tree, options), options);
}

}  // namespace twinmap::cli
