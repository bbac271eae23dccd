#pragma once

#include <string>

#include "framework/robots/robot.hpp"

namespace twinmap::robots {

/// With a point in front of an exponent: to YAML 1.1, 1e-06 is a text. -0 as 0.
std::string writeNumber(double value);

/// "[1, 2, 3]".
std::string writeVector(const Vector& v);

bool isZero(const Vector& v);

/// "point: ..., orientation: ...", of which those are left out that are 0.
std::string writePose(const Pose& frame);

/// ", in_parent: {point: ..., orientation: ...}", or "" at the origin.
std::string writeFrame(const char* key, const Pose& frame);

}  // namespace twinmap::robots
