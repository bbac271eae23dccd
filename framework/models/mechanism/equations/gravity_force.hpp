#pragma once

#include <vector>

#include "framework/models/mechanism/equations/tree.hpp"
#include "framework/models/mechanism/system_names.hpp"

namespace twinmap::equations {

template <class S>
bool isCarried(const SystemValues<S>& system, int body, int by) {
  while (body > by) {
    body = system.bodies[body].parent;
  }
  return body == by;
}

/// What gravity exerts on a coordinate that takes forces, by the body of its joint and all that it carries.
/// It is the sum of m g . dp/dq, with p the centre of mass.
template <class S>
S calcGravityForce(const SystemValues<S>& system, const std::vector<BodyMotion<S>>& motions,
                   const CoordinatePlace& place) {
  const BodyMotion<S>& joint = motions[place.body];
  const Spatial<S>& column = joint.columns[place.local];
  S force = 0.0;
  for (int i = place.body; i < static_cast<int>(motions.size()); ++i) {
    if (isCarried(system, i, place.body)) {
      const BodyValues<S>& body = system.bodies[i];
      const Transform<S>& pose = motions[i].pose;
      const Vec3<S> arm = pose.origin - joint.pose.origin + pose.rotation * body.center;
      force = force + body.mass * dot(system.gravity, column.linear + cross(column.angular, arm));
    }
  }
  return force;
}

}  // namespace twinmap::equations
