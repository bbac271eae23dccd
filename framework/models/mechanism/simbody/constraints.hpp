#pragma once

#include <Simbody.h>

#include <vector>

#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Adds the constraints of a system to the bodies, which exist already, by Simbody's own classes; returns
/// those of each of the file's. Throws SimulationFailure as calcConstraintNumbers() does.
std::vector<std::vector<SimTK::ConstraintIndex>> addConstraints(SimTK::SimbodyMatterSubsystem& matter,
                                                                const SystemSpec& spec,
                                                                const SystemNames& names,
                                                                ModelNumbers& numbers);

}  // namespace twinmap
