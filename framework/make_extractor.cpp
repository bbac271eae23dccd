#include "framework/make_extractor.hpp"

#include "framework/multibody/input_signals.hpp"

namespace twinmap {

FeatureExtractor makeExtractor(const ExperimentSpec& experiment, const ResponseLayout& layout) {
  const bool needed = needExcitation(experiment.features);
  return {experiment.features, layout,
          needed ? calcInputSignals(experiment.model, layout.times) : InputSignals{}};
}

}  // namespace twinmap
