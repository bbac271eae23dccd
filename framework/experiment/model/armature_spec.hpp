#pragma once

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// Inertia that a coordinate has by itself: that of a drive's rotor, times the square of the gear's ratio.
/// It takes inertia * q'' and nothing else, as in MuJoCo and Pinocchio.
struct ArmatureSpec {
  Name coordinate;
  Expression inertia;
};

template <class Fields>
void describe(Fields& f, ArmatureSpec& s) {
  f.required("coordinate", s.coordinate, "that a drive moves", Reference::kForcedCoordinate);
  f.required("inertia", s.inertia, "of the rotor, times the square of the gear's ratio", Unit{"kg", "kg m2"});
}

}  // namespace twinmap
