#include "framework/experiment/require_model.hpp"

#include "framework/features/feature_extractor.hpp"
#include "framework/model_source/make_simulator.hpp"
#include "framework/spec/check/check_features.hpp"

namespace twinmap {

void requireModel(const ExperimentSpec& experiment) {
  makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features))
      ->checkStart();
}

}  // namespace twinmap
