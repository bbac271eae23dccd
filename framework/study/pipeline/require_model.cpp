#include "framework/study/pipeline/require_model.hpp"

#include <algorithm>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

namespace {

/// Estimators that are trained know uniform priors alone; posteriors of the simulator know all.
void requireKnownPriors(const ExperimentSpec& experiment) {
  if (experiment.inverse_map.isNone()) {
    return;
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  const auto stated = std::find_if(unknown.begin(), unknown.end(), [](const ParameterSpec& parameter) {
    return parameter.prior.has_value();
  });
  if (stated != unknown.end() || !experiment.model.priors.empty()) {
    const SourceLocation& where =
        stated != unknown.end() ? stated->name.where : experiment.model.priors.front().where;
    throw ExperimentError(
        where, stated != unknown.end() ? stated->name.text : "priors",
        "has a prior, which trained estimators do not know: set 'inverse_map: none', or leave "
        "the prior out");
  }
}

}  // namespace

void requireModel(const ExperimentSpec& experiment) {
  requireKnownPriors(experiment);
  makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features))
      ->checkStart();
}

}  // namespace twinmap
