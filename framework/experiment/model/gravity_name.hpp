#pragma once

namespace twinmap {

/// <coordinate>_gravity is the force of gravity on a coordinate that takes forces, by all that its joint
/// carries. Whatever else is called so has the name.
inline constexpr const char* kGravitySuffix = "_gravity";

}  // namespace twinmap
