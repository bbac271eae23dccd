#pragma once

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Builds the model at the centre of the bounds (Simulator::checkStart). Throws ExperimentError if it
/// cannot exist there.
void requireModel(const ExperimentSpec& experiment);

}  // namespace twinmap
