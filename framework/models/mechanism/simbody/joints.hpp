#pragma once

#include <Simbody.h>

#include "framework/experiment/model/system_spec.hpp"
#include "framework/simulation/number_evaluator.hpp"

namespace twinmap {

/// A frame fixed to a body from its origin (m) and body-fixed x-y-z angles (rad).
SimTK::Transform calcFrame(const FrameSpec& frame, NumberEvaluator& numbers, const std::string& owner);

/// The joint frames of parent and body, aligned with the joint's axis, and the pitch of a screw (m/rad).
struct JointNumbers {
  SimTK::Transform in_parent, in_body;
  double pitch;
};

/// Throws SimulationFailure for an axis of no length and numbers that are not finite.
JointNumbers calcJointNumbers(const BodySpec& spec, NumberEvaluator& numbers);

/// Adds a body to Simbody's tree by its joint. The joint frames of parent and body coincide where all
/// coordinates are 0. A joint with an axis moves along or about that axis of the joint frame; by default
/// Simbody's own: x for a slider, z for the others. Throws SimulationFailure for an axis of no length.
void addMobilizer(SimTK::MobilizedBody parent, const SimTK::Body& body, const BodySpec& spec,
                  NumberEvaluator& numbers);

}  // namespace twinmap
