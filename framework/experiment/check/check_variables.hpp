#pragma once

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Whether variables are those of a model from elsewhere, which has no coordinates, and its files exist.
/// Throws ExperimentError.
void checkVariables(const ModelSpec& model);

}  // namespace twinmap
