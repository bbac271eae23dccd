#pragma once

#include <Simbody.h>

#include "framework/experiment/model/system_spec.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Adds a body to Simbody's tree by its joint. The joint frames of parent and body coincide where all
/// coordinates are 0. A joint with an axis moves along or about that axis of the joint frame; by default
/// Simbody's own: x for a slider, z for the others. Throws SimulationFailure for an axis of no length.
void addMobilizer(SimTK::MobilizedBody parent, const SimTK::Body& body, const BodySpec& spec,
                  ModelNumbers& numbers);

}  // namespace twinmap
