#pragma once

#include <algorithm>
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

/// Linear acceleration of a point of a body, in ground.
template <class S>
Vec3<S> calcPointAcceleration(const SystemValues<S>& system, const ModelMotion<S>& motion, int at,
                              const PointMotion<S>& point) {
  const Spatial<S> acceleration = calcBodyAcceleration(system, motion, at);
  const Vec3<S>& spin = motion.bodies[at].velocity.angular;
  return acceleration.linear + cross(acceleration.angular, point.arm) + cross(spin, cross(spin, point.arm));
}

/// What an accelerometer or a gyroscope on a body reads.
template <class S>
S calcBodySensor(const OutputSpec& spec, const SystemNames& names, const NamedValues<S>& values,
                 const SystemValues<S>& system, const ModelMotion<S>& motion) {
  const BodySensorSpec& at = spec.specific_force ? *spec.specific_force : *spec.angular_velocity;
  const Station<S> station = calcStation(at.station, names, values);
  const BodyMotion<S>& body = motion.bodies[station.body];
  const Vec3<S> direction = body.pose.rotation * normalize(values.calc3(at.direction));
  if (spec.angular_velocity) {
    return dot(body.velocity.angular, direction);
  }
  const Vec3<S> acceleration =
      calcPointAcceleration(system, motion, station.body, calcPoint(body, station.point));
  return dot(acceleration - system.gravity, direction);
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
  return dot(calcPointAcceleration(system, motion, station.body, point), direction);
}

/// Whether any output is an expression, which may use accelerations (<coordinate>_ddot).
inline bool hasExpression(const std::vector<OutputSpec>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const OutputSpec& output) { return !output.expression.text.empty(); });
}

/// gain * quantity + offset. `values`: parameters, constants and what expressions of outputs may use.
template <class S>
S calcOutput(const OutputSpec& spec, const SystemNames& names, const NamedValues<S>& values,
             const SystemValues<S>& system, const ModelState<S>& state, const ModelMotion<S>& motion) {
  const bool of_body = spec.specific_force || spec.angular_velocity;
  const S quantity = spec.coordinate ? state.coordinates[names.findCoordinate(*spec.coordinate)]
                     : spec.speed    ? motion.rates[names.findCoordinate(*spec.speed)]
                     : of_body       ? calcBodySensor(spec, names, values, system, motion)
                     : !spec.expression.text.empty() ? values.calc(spec.expression)
                                                     : calcStationOutput(spec, names, values, system, motion);
  return values.calc(spec.gain, 1.0) * quantity + values.calc(spec.offset, 0.0);
}

}  // namespace twinmap::equations
