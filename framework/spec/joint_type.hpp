#pragma once

#include <vector>

#include "framework/spec/system_spec.hpp"

namespace twinmap {

enum class CoordinateKind { kRotation, kTranslation };

/// The coordinates of a joint in their order.
const std::vector<CoordinateKind>& getCoordinateKinds(JointType type);

int getCoordinateCount(JointType type);

/// Slider, pin, screw and cylinder move along or about one axis.
bool hasAxis(JointType type);

/// "rad" or "m".
const char* getUnit(CoordinateKind kind);

}  // namespace twinmap
