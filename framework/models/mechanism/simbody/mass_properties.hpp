#pragma once

#include <Simbody.h>

#include "framework/models/mechanism/system_numbers.hpp"

namespace twinmap {

inline SimTK::Vec3 toVec3(const Eigen::Vector3d& values) {
  return SimTK::Vec3(values[0], values[1], values[2]);
}

SimTK::Transform toTransform(const FrameNumbers& frame);

/// With the inertia about the body's origin.
SimTK::MassProperties toMassProperties(const MassNumbers& numbers);

}  // namespace twinmap
