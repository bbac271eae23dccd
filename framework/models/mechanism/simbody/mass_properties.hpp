#pragma once

#include <Simbody.h>

#include "framework/experiment/model/system_spec.hpp"
#include "framework/simulation/number_evaluator.hpp"

namespace twinmap {

SimTK::Vec3 calcVec3(NumberEvaluator& numbers, const Expression3& expressions, const Quantity& quantity);

/// Mass, centre of mass and inertia about the body's origin (Steiner's theorem). Throws SimulationFailure
/// unless the mass is positive and the inertia is that of a real body: its principal moments not negative and
/// none above the sum of the other two.
SimTK::MassProperties calcMassProperties(const BodySpec& body, NumberEvaluator& numbers);

}  // namespace twinmap
