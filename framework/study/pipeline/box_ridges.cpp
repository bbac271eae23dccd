#include "framework/study/pipeline/box_ridges.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/ridges/simulated_ridges.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

std::vector<std::string> adviseOnBox(const ExperimentSpec& experiment) {
  const std::unique_ptr<Simulator> simulator =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  if (!simulator->hasDerivatives() || !asksForInformationLimit(experiment)) {
    return {};
  }
  const FeatureExtractor extractor = makeExtractor(experiment, simulator->getLayout());
  const ResponseNoise response_noise(experiment.noise, simulator->getLayout());
  if (!(response_noise.getStddev().minCoeff() > 0.0)) {
    return {};  // what is seen without noise tells everything apart
  }
  const FeatureNoise noise(extractor, response_noise, experiment.seed);
  return adviseOnRidges(
      simulateRidges(*simulator, extractor, noise, experiment.model, sampleTestPoints(experiment), 1),
      experiment.model.parameters);
}

}  // namespace twinmap
