#pragma once

#include <string>

#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

/// Compares the recorded programs with Simbody's realize(Acceleration), and the outputs, at random parameter
/// sets of the box, states and times. Returns "" where they agree to 1e-10 of the largest, else what differs.
/// Cost: some ms.
std::string compareWithSimbody(ModelContext& context, const LaneModel& model);

}  // namespace twinmap
