#pragma once

#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

/// Throws SimulationFailure for numbers of the current parameter set that no real system has, as building it
/// would, and in the same order. Cost: some microseconds.
void checkNumbers(ModelContext& context);

}  // namespace twinmap
