#include <iostream>
#include <set>

#include "framework/cli/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/sweep/model_groups.hpp"

namespace twinmap::cli {

void check(const ExperimentArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.file, arguments.overrides);
  std::set<std::string> engines;
  for (const ModelGroup& group : groupByModel(expandCasesWithSignals(tree))) {  // what is wrong in any case
    const std::unique_ptr<Simulator> simulator = makeSimulator(group.model, group.times, group.modes);
    simulator->checkStart();
    engines.insert(simulator->getEngine());
  }
  for (const std::string& engine : engines) {
    std::cout << "# simulated by: " << engine << '\n';
  }
  if (readExperiment(tree).inverse_map.isNone()) {
    std::cout << "# no inverse map: measurements are answered by their posterior on the simulator\n";
  }
  if (tree.find("sweep") != nullptr) {
    std::cout << writeIndependentDefaults(tree);
    return;
  }
  std::cout << writeExperiment(readExperimentWithSignals(tree));
}

}  // namespace twinmap::cli
