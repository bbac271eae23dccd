#pragma once

#include "framework/inference/tolerances/integration_errors.hpp"

namespace twinmap {

/// A warning where estimates depend on the onset speed of regularised friction, which no machine has: where
/// half of it moves one by more than half of its standard deviation, at any of the points of `errors`; else
/// "". Nothing is compared where it is a parameter. Cost: none without such friction, else 32 simulations; 16
/// more with derivatives where the difference is not far below the noise.
std::string describeOnsetSpeeds(const ExperimentSpec& experiment, IntegrationErrors& errors);

}  // namespace twinmap
