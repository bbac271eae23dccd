#pragma once

#include <string>

#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "framework/models/mechanism/simbody_model.hpp"

namespace twinmap {

/// Compares the recorded programs with Simbody's realize(Acceleration), and the outputs, at random parameter
/// sets of the box, states and times. Returns "" where they agree to 1e-10 of the largest, else what differs.
/// `context` and `simbody`: of the same model. Cost: some ms.
std::string compareWithSimbody(ModelContext& context, SimbodyModel& simbody, const LaneModel& model);

}  // namespace twinmap
