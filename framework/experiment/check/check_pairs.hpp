#pragma once

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What slides against another coordinate or meets it must move alike, and what sticks or is thrown back must
/// be free to do so and be held once. Throws ExperimentError. Coordinates must be known.
void checkPairs(const ModelSpec& model);

}  // namespace twinmap
