#pragma once

#include <algorithm>
#include <vector>

#include "framework/models/mechanism/equations/reactions.hpp"

namespace twinmap::equations {

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
/// Whether any is what an element exerts, whose law may be an expression.
inline bool hasForce(const std::vector<OutputSpec>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const OutputSpec& output) { return output.force_of.has_value(); });
}

/// Of a force element, constraint or prescribed motion. `values`: with what expressions of the state may use.
template <class S>
S calcForceOutput(const OutputSpec& spec, const SystemNames& names, const NamedValues<S>& values,
                  const SystemValues<S>& system, const ModelState<S>& state, const ModelMotion<S>& motion) {
  const NamedForce& which = names.findForce(*spec.force_of);
  if (which.motion >= 0) {
    return motion.driving[static_cast<std::size_t>(which.motion)];
  }
  Loads<S> loads = makeLoads<S>(motion.bodies.size(), state.coordinates.size(), state.states.size());
  ForceSum<S, NamedValues<S>> sum(motion.bodies, state.coordinates, motion.rates, state.states, values, loads,
                                  &state.modes);
  if (which.constraint < 0 && !spec.component) {
    return calcElementForce(system.elements, which, sum).along +
           calcHeldForce(system.elements, which, motion.held);
  }
  const Exerted<S> exerted = which.constraint >= 0 ? calcConstraintForce(system, motion, which.constraint)
                                                   : calcElementForce(system.elements, which, sum);
  return spec.component ? getComponent(exerted.force, exerted.moment, *spec.component) : exerted.along;
}

template <class S>
S calcReactionOutput(const OutputSpec& spec, const SystemNames& names, const SystemValues<S>& system,
                     const ModelMotion<S>& motion) {
  const Spatial<S> reaction = calcReaction(system, motion, names.findJoint(spec.reaction->joint));
  return getComponent(reaction.linear, reaction.angular, spec.reaction->component);
}

/// gain * quantity + offset. `values`: parameters, constants and what expressions of outputs may use.
template <class S>
S calcOutput(const OutputSpec& spec, const SystemNames& names, const NamedValues<S>& values,
             const SystemValues<S>& system, const ModelState<S>& state, const ModelMotion<S>& motion) {
  const bool of_body = spec.specific_force || spec.angular_velocity;
  const S quantity = spec.coordinate ? state.coordinates[names.findCoordinate(*spec.coordinate)]
                     : spec.speed    ? motion.rates[names.findCoordinate(*spec.speed)]
                     : of_body       ? calcBodySensor(spec, names, values, system, motion)
                     : spec.reaction ? calcReactionOutput(spec, names, system, motion)
                     : spec.force_of ? calcForceOutput(spec, names, values, system, state, motion)
                     : !spec.expression.text.empty() ? values.calc(spec.expression)
                                                     : calcStationOutput(spec, names, values, system, motion);
  return values.calc(spec.gain, 1.0) * quantity + values.calc(spec.offset, 0.0);
}

}  // namespace twinmap::equations
