#pragma once

#include <vector>

#include "framework/experiment/feature_spec.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Checks the features against the model: outputs exist and are named once in a feature, samples lie within
/// the simulation. Throws ExperimentError.
void checkFeatures(const std::vector<FeatureSpec>& features, const ModelSpec& model);

/// Throws ExperimentError where the features need so many samples that listing their times would take long.
void requireFewSamples(const std::vector<FeatureSpec>& features, const SourceLocation& where);

}  // namespace twinmap
