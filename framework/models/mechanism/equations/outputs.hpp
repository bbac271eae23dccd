#pragma once

#include <vector>

#include "framework/models/mechanism/equations/model_equations.hpp"

namespace twinmap::equations {

/// Angular acceleration of a body and linear acceleration of its origin, in ground.
template <class S>
Spatial<S> calcBodyAcceleration(const SystemValues<S>& system, const ModelMotion<S>& motion, int body) {
  // the accelerations that u' adds run down the tree as velocities do
  Spatial<S> added;
  for (int at = body; at > 0; at = system.bodies[at].parent) {
    const Vec3<S> reach = motion.bodies[body].pose.origin - motion.bodies[at].pose.origin;
    for (int k = 0; k < system.bodies[at].speed_count; ++k) {
      const Spatial<S> part =
          scale(motion.accelerations[system.bodies[at].first_speed + k], motion.bodies[at].columns[k]);
      added = added + Spatial<S>{part.angular, part.linear + cross(part.angular, reach)};
    }
  }
  return motion.bodies[body].bias + added;
}

template <class S>
S calcStationOutput(const OutputSpec& spec, const SystemNames& names, const NamedValues<S>& values,
                    const SystemValues<S>& system, const ModelMotion<S>& motion) {
  const StationOutputSpec& at = spec.position   ? *spec.position
                                : spec.velocity ? *spec.velocity
                                                : *spec.acceleration;
  const Station<S> station = calcStation(at.station, names, values);
  const Vec3<S> direction = normalize(values.calc3(at.direction));
  const BodyMotion<S>& body = motion.bodies[station.body];
  const PointMotion<S> point = calcPoint(body, station.point);
  if (!spec.acceleration) {
    return dot(spec.position ? point.place : point.velocity, direction);
  }
  const Spatial<S> acceleration = calcBodyAcceleration(system, motion, station.body);
  const Vec3<S>& spin = body.velocity.angular;
  return dot(
      acceleration.linear + cross(acceleration.angular, point.arm) + cross(spin, cross(spin, point.arm)),
      direction);
}

/// gain * quantity + offset. `values`: parameters and constants.
template <class S>
S calcOutput(const OutputSpec& spec, const SystemNames& names, const NamedValues<S>& values,
             const SystemValues<S>& system, const ModelState<S>& state, const ModelMotion<S>& motion) {
  const S quantity = spec.coordinate ? state.coordinates[names.findCoordinate(*spec.coordinate)]
                     : spec.speed    ? motion.rates[names.findCoordinate(*spec.speed)]
                                     : calcStationOutput(spec, names, values, system, motion);
  return values.calc(spec.gain, 1.0) * quantity + values.calc(spec.offset, 0.0);
}

}  // namespace twinmap::equations
