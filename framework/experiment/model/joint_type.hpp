#pragma once

#include <vector>

#include "framework/experiment/model/body_spec.hpp"

namespace twinmap {

enum class CoordinateKind { kTranslation, kRotation };

/// One coordinate of a joint. `takes_forces`: its speed is its time derivative, so that springs, dampers and
/// force laws may act on it directly. The three angles of ball and free joints do not: their speeds are the
/// components of the angular velocity; use a bushing, an applied moment, or a gimbal or bushing joint.
struct JointCoordinate {
  CoordinateKind kind;
  bool takes_forces;
};

/// The coordinates of a joint in their order.
const std::vector<JointCoordinate>& getJointCoordinates(JointType type);
int getCoordinateCount(JointType type);

/// True for the joints that take an `axis`: slider, pin, screw and cylinder.
bool hasAxis(JointType type);

/// "m" or "rad"; and of its time derivative, "m/s" or "rad/s".
const char* getUnit(CoordinateKind kind);
const char* getSpeedUnit(CoordinateKind kind);

}  // namespace twinmap
