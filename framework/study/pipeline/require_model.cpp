#include "framework/study/pipeline/require_model.hpp"

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/experiment/check/uniform_priors.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

void requireModel(const ExperimentSpec& experiment) {
  if (!experiment.inverse_map.isNone()) {
    requireUniformPriors(
        experiment.model,
        "has a prior, which trained estimators do not know: set 'inverse_map: none', or leave "
        "the prior out");
  }
  makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features))
      ->checkStart();
}

}  // namespace twinmap
