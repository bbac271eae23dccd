#pragma once

#include <Simbody.h>

#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Adds the constraints of a system to the bodies, which exist already, by Simbody's own classes. Throws
/// SimulationFailure as calcConstraintNumbers() does.
void addConstraints(SimTK::SimbodyMatterSubsystem& matter, const SystemSpec& spec, const SystemNames& names,
                    ModelNumbers& numbers);

}  // namespace twinmap
