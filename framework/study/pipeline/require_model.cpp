#include "framework/study/pipeline/require_model.hpp"

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

void requireModel(const ExperimentSpec& experiment) {
  makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features))
      ->checkStart();
}

}  // namespace twinmap
