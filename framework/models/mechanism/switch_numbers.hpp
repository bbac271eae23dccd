#pragma once

#include <Eigen/Core>

#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Throws SimulationFailure for a restitution beyond 0 to 1, and for a level of friction that sticks which is
/// negative, at the numbers' parameter set.
void checkSwitchNumbers(const SystemSpec& system, ModelNumbers& numbers);

/// Throws SimulationFailure for coordinates beyond a rigid stop by more than rounding. `coordinates`: in the
/// order of SystemNames.
void requireWithinStops(const SystemSpec& system, const SystemNames& names, ModelNumbers& numbers,
                        const Eigen::Ref<const Eigen::VectorXd>& coordinates);

}  // namespace twinmap
