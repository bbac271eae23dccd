#pragma once

#include <algorithm>
#include <vector>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/model_equations.hpp"

// What joints, force elements and constraints exert, from the accelerations of a motion.

namespace twinmap::equations {

inline bool hasReaction(const std::vector<OutputSpec>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const OutputSpec& output) { return output.reaction.has_value(); });
}

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

/// What a condition exerts on `to`, and against it on `from`: in ground axes, at a place of each.
template <class S>
struct ClosureAction {
  Vec3<S> force, moment;
  Vec3<S> from_place, to_place;
};

/// `multiplier`: its entry of ModelMotion::closure_forces. A gear acts on coordinates alone.
template <class S>
ClosureAction<S> calcClosureAction(const Closure<S>& closure, const std::vector<BodyMotion<S>>& motions,
                                   const S& multiplier) {
  ClosureAction<S> action;
  if (closure.kind == ClosureKind::kGear) {
    return action;
  }
  const BodyMotion<S>&from = motions[closure.from.body], &to = motions[closure.to.body];
  action.from_place = action.to_place = calcPoint(to, closure.to.point).place;
  if (closure.kind == ClosureKind::kRolling) {
    action.from_place = action.to_place = calcTouch(closure, motions);
    action.force = scale(S(-multiplier), from.pose.rotation * closure.across);
  } else if (closure.kind == ClosureKind::kPlane) {
    action.force = scale(S(-multiplier), from.pose.rotation * closure.normal);
  } else if (closure.kind == ClosureKind::kRod) {
    action.from_place = calcPoint(from, closure.from.point).place;
    action.force = scale(S(-multiplier / closure.length), action.to_place - action.from_place);
  } else {
    action.moment =
        scale(S(-multiplier), cross(to.pose.rotation * closure.across, from.pose.rotation * closure.normal));
  }
  return action;
}

/// Adds what all conditions exert to the forces on bodies, at their origins.
template <class S>
void addClosureLoads(const SystemValues<S>& system, const ModelMotion<S>& motion,
                     std::vector<Spatial<S>>& loads) {
  const auto add = [&](int body, const Vec3<S>& place, const Vec3<S>& force, const Vec3<S>& moment) {
    const Vec3<S> arm = place - motion.bodies[body].pose.origin;
    loads[body] = loads[body] + Spatial<S>{moment + cross(arm, force), force};
  };
  for (std::size_t k = 0; k < system.closures.size(); ++k) {
    const Closure<S>& closure = system.closures[k];
    if (closure.kind != ClosureKind::kGear) {
      const ClosureAction<S> action = calcClosureAction(closure, motion.bodies, motion.closure_forces[k]);
      add(closure.to.body, action.to_place, action.force, action.moment);
      add(closure.from.body, action.from_place, -action.force, -action.moment);
    }
  }
}

/// What a constraint exerts, the file's `place`-th: `along` is a gear's force on its coordinate, the pull of
/// a rod and the pressure of a plane, which that of rolling is too. Of conditions that are redundant the
/// force is not determined, and 0 here.
template <class S>
Exerted<S> calcConstraintForce(const SystemValues<S>& system, const ModelMotion<S>& motion, int place) {
  Exerted<S> sum;
  for (std::size_t k = 0; k < system.closures.size(); ++k) {
    const Closure<S>& closure = system.closures[k];
    if (closure.constraint == place) {
      const S& multiplier = motion.closure_forces[k];
      const ClosureAction<S> action = calcClosureAction(closure, motion.bodies, multiplier);
      if (closure.kind != ClosureKind::kRolling) {
        sum.along = closure.kind == ClosureKind::kRod ? multiplier : -multiplier;
      }
      sum.force = closure.swapped ? sum.force - action.force : sum.force + action.force;
      sum.moment = closure.swapped ? sum.moment - action.moment : sum.moment + action.moment;
    }
  }
  return sum;
}

/// What an element exerts at the state of `sum`, to which its forces are added.
template <class S, class Named>
Exerted<S> calcElementForce(const ForceElements<S>& elements, const NamedForce& which,
                            ForceSum<S, Named>& sum) {
  sum.takeExerted();
  int kind = 0;
  elements.forEachList([&](const auto& list) {
    if (kind++ == which.kind) {
      addForces(list[which.index], sum);
    }
  });
  return sum.takeExerted();
}

/// The force with which an element that switches holds its coordinate: a stop on which it rests, friction
/// that sticks; 0 of all others. `held`: of ModelMotion.
template <class S>
S calcHeldForce(const ForceElements<S>& elements, const NamedForce& which, const std::vector<S>& held) {
  const void* wanted = nullptr;
  int kind = 0;
  elements.forEachList([&](const auto& list) {
    if (kind++ == which.kind) {
      wanted = &list[which.index];
    }
  });
  std::vector<const void*> switching;  // in the order of the modes
  for (const Stop<S>* stop : listRigidStops(elements)) {
    switching.push_back(stop);
  }
  for (const Friction<S>* friction : listSticking(elements)) {
    switching.push_back(friction);
  }
  const auto mode =
      static_cast<std::size_t>(std::find(switching.begin(), switching.end(), wanted) - switching.begin());
  return mode < held.size() ? held[mode] : S(0.0);
}

/// What a joint exerts on its body: moment and force at the joint's frame on the body, in the axes of the
/// parent. By Newton and Euler: what the body and all that it carries need for their accelerations beyond
/// what acts on them. The forces on the joint's coordinates are part of it, as they pass between the same two
/// bodies.
template <class S>
Spatial<S> calcReaction(const SystemValues<S>& system, const ModelMotion<S>& motion, int body) {
  std::vector<Spatial<S>> loads = motion.loads;
  addClosureLoads(system, motion, loads);
  const Transform<S>& pose = motion.bodies[body].pose;
  const Vec3<S> place = pose.origin + pose.rotation * system.bodies[body].in_body.origin;
  Spatial<S> total;
  std::vector<bool> carried(system.bodies.size(), false);
  for (std::size_t i = body; i < system.bodies.size(); ++i) {
    carried[i] = static_cast<int>(i) == body || carried[system.bodies[i].parent];
    if (carried[i]) {
      BodyMotion<S> moved = motion.bodies[i];
      moved.bias = calcBodyAcceleration(system, motion, static_cast<int>(i));
      const Spatial<S> missing = calcComposite(system.bodies[i], moved, loads[i]).force;
      const Vec3<S> arm = moved.pose.origin - place;
      total = total - Spatial<S>{missing.angular + cross(arm, missing.linear), missing.linear};
    }
  }
  const Mat33<S> axes = transpose(motion.bodies[system.bodies[body].parent].pose.rotation);
  return {axes * total.angular, axes * total.linear};
}

/// A component of a force and moment.
template <class S>
S getComponent(const Vec3<S>& force, const Vec3<S>& moment, ForceComponent component) {
  const Vec3<S>& vector = isMoment(component) ? moment : force;
  const int axis = getAxis(component);
  return axis == 0 ? vector.x : axis == 1 ? vector.y : vector.z;
}

}  // namespace twinmap::equations
