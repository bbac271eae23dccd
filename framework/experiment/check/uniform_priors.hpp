#pragma once

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Throws ExperimentError with this rule where an unknown parameter has a prior that is not uniform, or
/// several have one together.
void requireUniformPriors(const ModelSpec& model, const char* rule);

}  // namespace twinmap
