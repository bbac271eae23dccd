#pragma once

#include <vector>

#include "framework/models/mechanism/equations/tree.hpp"

namespace twinmap::equations {

/// Below this distance (m) two points have no direction between them, and exert no force on each other.
constexpr double kCoincident = 1e-12;

/// Sums forces on bodies (at their origins, in ground axes) and on speeds.
template <class S>
struct ForceSum {
  const SystemValues<S>& system;
  const std::vector<BodyMotion<S>>& motions;
  std::vector<Spatial<S>> on_bodies;
  std::vector<S> on_speeds;

  ForceSum(const SystemValues<S>& values, const std::vector<BodyMotion<S>>& moving)
      : system(values),
        motions(moving),
        on_bodies(moving.size()),
        on_speeds(values.coordinate_count, S(0.0)) {}

  void addAt(int body, const Vec3<S>& arm, const Vec3<S>& force) {
    on_bodies[body] = on_bodies[body] + Spatial<S>{cross(arm, force), force};
  }
  void addMoment(int body, const Vec3<S>& moment) {
    on_bodies[body].angular = on_bodies[body].angular + moment;
  }
  void addOnCoordinate(int coordinate, const S& force) {
    on_speeds[coordinate] = on_speeds[coordinate] + force;
  }
};

/// A point of a body: from its origin in ground axes, and its place and velocity in ground.
template <class S>
struct PointMotion {
  Vec3<S> arm, place, velocity;
};

template <class S>
PointMotion<S> calcPoint(const BodyMotion<S>& body, const Vec3<S>& point) {
  const Vec3<S> arm = body.pose.rotation * point;
  return {arm, body.pose.origin + arm, body.velocity.linear + cross(body.velocity.angular, arm)};
}

template <class S>
void addSeverity(ForceSum<S>& sum) {
  for (std::size_t i = 1; i < sum.motions.size(); ++i) {
    const BodyValues<S>& body = sum.system.bodies[i];
    sum.addAt(static_cast<int>(i), sum.motions[i].pose.rotation * body.center,
              scale(body.mass, sum.system.gravity));
  }
}

/// Adds a pull of `tension(distance, rate)` between two stations.
template <class S, class Tension>
void addPull(const StationValues<S>& from, const StationValues<S>& to, ForceSum<S>& sum, Tension tension) {
  using namespace program::real;
  const PointMotion<S> first = calcPoint(sum.motions[from.body], from.point);
  const PointMotion<S> second = calcPoint(sum.motions[to.body], to.point);
  const Vec3<S> between = second.place - first.place;
  const S zero = 0.0, one = 1.0;
  const S squared = dot(between, between);
  const S apart = lessOrEqual(S(kCoincident * kCoincident), squared);
  const S distance = sqrt(select(apart, squared, one));  // 1 in place of 0, whose root has no derivative
  const S inverse = select(apart, one / distance, zero);
  const Vec3<S> direction = scale(inverse, between);
  const Vec3<S> pull = scale(tension(distance, dot(second.velocity - first.velocity, direction)), direction);
  sum.addAt(from.body, first.arm, pull);
  sum.addAt(to.body, second.arm, -pull);
}

/// Body-fixed x-y-z angles of a rotation, the middle one within +-90 degrees.
template <class S>
Vec3<S> calcAngles(const Mat33<S>& r) {
  using namespace program::real;
  return {atan2(-r.z.y, r.z.z), atan2(r.z.x, sqrt(r.x.x * r.x.x + r.y.x * r.y.x)), atan2(-r.y.x, r.x.x)};
}

template <class S>
Vec3<S> calcResistance(const BushingValues<S>& bushing, int first, const Vec3<S>& q, const Vec3<S>& rates) {
  const std::vector<S>&k = bushing.stiffness, &d = bushing.damping;
  return {-(k[first] * q.x + d[first] * rates.x), -(k[first + 1] * q.y + d[first + 1] * rates.y),
          -(k[first + 2] * q.z + d[first + 2] * rates.z)};
}

/// As twinmap::addBushing.
template <class S>
void addBushing(const BushingValues<S>& bushing, ForceSum<S>& sum) {
  const BodyMotion<S>&from = sum.motions[bushing.from.body], &to = sum.motions[bushing.to.body];
  const Transform<S> from_frame = from.pose * bushing.from.frame, to_frame = to.pose * bushing.to.frame;
  const Transform<S> relative = invert(from_frame) * to_frame;
  const Mat33<S> back = transpose(from_frame.rotation);
  const Vec3<S> to_arm = to_frame.origin - to.pose.origin, from_arm = to_frame.origin - from.pose.origin;
  const Vec3<S> at_point = to.velocity.linear + cross(to.velocity.angular, to_arm);
  const Vec3<S> carried = from.velocity.linear + cross(from.velocity.angular, from_arm);
  const Vec3<S> angles = calcAngles(relative.rotation);
  const Mat33<S> rates = calcAngleRates(angles);
  const Vec3<S> spin = rates * (back * (to.velocity.angular - from.velocity.angular));
  // virtual power: torque . angular velocity = angle forces . angle rates, so torque = N' * angle forces
  const Vec3<S> torque = from_frame.rotation * (transpose(rates) * calcResistance(bushing, 0, angles, spin));
  const Vec3<S> force =
      from_frame.rotation * calcResistance(bushing, 3, relative.origin, back * (at_point - carried));
  sum.addAt(bushing.to.body, to_arm, force);
  sum.addAt(bushing.from.body, from_arm, -force);
  sum.addMoment(bushing.to.body, torque);
  sum.addMoment(bushing.from.body, -torque);
}

/// Severity, springs, dampers, bushings. `rates`: time derivatives of the coordinates.
template <class S>
void addPassiveForces(const std::vector<S>& q, const std::vector<S>& rates, ForceSum<S>& sum) {
  addSeverity(sum);
  for (const SpringValues<S>& spring : sum.system.springs) {
    sum.addOnCoordinate(spring.coordinate, -(spring.stiffness * (q[spring.coordinate] - spring.rest)));
  }
  for (const DamperValues<S>& damper : sum.system.dampers) {
    sum.addOnCoordinate(damper.coordinate, -(damper.damping * rates[damper.coordinate]));
  }
  for (const TwoPointSpringValues<S>& spring : sum.system.two_point_springs) {
    addPull(spring.from, spring.to, sum, [&spring](const S& distance, const S&) {
      return spring.stiffness * (distance - spring.rest_length);
    });
  }
  for (const TwoPointDamperValues<S>& damper : sum.system.two_point_dampers) {
    addPull(damper.from, damper.to, sum,
            [&damper](const S&, const S& rate) { return damper.damping * rate; });
  }
  for (const BushingValues<S>& bushing : sum.system.bushings) {
    addBushing(bushing, sum);
  }
}

}  // namespace twinmap::equations
