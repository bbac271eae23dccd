#pragma once

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A coordinate that moves as a signal says, with the signal's speed and acceleration, whatever the forces.
struct MotionSpec {
  Name coordinate;
  Name follows;  ///< a signal of the excitation
};

template <class Fields>
void describe(Fields& f, MotionSpec& s) {
  f.required("coordinate", s.coordinate, "whose motion is prescribed", Reference::kForcedCoordinate);
  f.required("follows", s.follows, "an excitation signal in the coordinate's unit");
}

}  // namespace twinmap
