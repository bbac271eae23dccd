#include <iostream>
#include <set>

#include "framework/cli/commands.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/ridges/simulated_ridges.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/sweep/model_groups.hpp"

namespace twinmap::cli {
namespace {

/// What the features determine of parameters that they do not determine one by one, as comments; "" where
/// they determine all, and where derivatives take more than some milliseconds.
std::string describeRidges(const ExperimentSpec& experiment) {
  const std::unique_ptr<Simulator> simulator =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  if (!simulator->hasDerivatives() || !asksForInformationLimit(experiment)) {
    return "";
  }
  const FeatureExtractor extractor = makeExtractor(experiment, simulator->getLayout());
  const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, simulator->getLayout()),
                           experiment.seed);
  std::string text;
  for (const std::string& advice : adviseOnRidges(
           simulateRidges(*simulator, extractor, noise, experiment.model, sampleTestPoints(experiment), 1),
           experiment.model.parameters)) {
    text += "# " + advice + "\n";
  }
  return text;
}

}  // namespace

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
  if (tree.find("sweep") != nullptr) {
    std::cout << writeIndependentDefaults(tree);
    return;
  }
  const ExperimentSpec experiment = readExperimentWithSignals(tree);
  std::cout << describeRidges(experiment) << writeExperiment(experiment);
}

}  // namespace twinmap::cli
