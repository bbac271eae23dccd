#include "framework/data/features/experiment_features.hpp"

#include "framework/experiment/model/output_units.hpp"
#include "framework/simulation/excitation/calc_input_signals.hpp"

namespace twinmap {

ResponseLayout makeLayout(const ExperimentSpec& experiment) {
  ResponseLayout layout;
  layout.times = collectTimes(experiment.features);
  layout.modes = countModes(experiment.features);
  if (layout.times.size() > 0) {
    for (const OutputSpec& output : experiment.model.outputs) {
      layout.output_names.push_back(output.name.text);
      layout.output_units.push_back(findOutputUnit(output, experiment.model.system));
    }
  }
  return layout;
}

FeatureExtractor makeExtractor(const ExperimentSpec& experiment, const ResponseLayout& layout) {
  const bool needed = needExcitation(experiment.features);
  return {experiment.features, layout,
          needed ? calcInputSignals(experiment.model, layout.times) : InputSignals{}};
}

}  // namespace twinmap
