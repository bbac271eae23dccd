#pragma once

#include <utility>
#include <vector>

#include "framework/models/mechanism/equations/force_sum.hpp"

namespace twinmap::equations {

/// A condition at a state: its value c, and c' = row * u, c'' = row * u' + bias. In m, rad between
/// directions, or the unit of a gear's coordinate.
template <class S>
struct ClosureTerms {
  S value, bias;
  std::vector<S> row;  ///< one entry a speed
};

/// The last body that carries both; bodies follow their parents.
template <class S>
int findCommonBody(const SystemValues<S>& system, int a, int b) {
  while (a != b) {
    (a > b ? a : b) = system.bodies[a > b ? a : b].parent;
  }
  return a;
}

/// Adds how fast a point at `place`, moved by the joints that carry `body` but not `other`, goes along
/// `direction` for a unit of each speed.
template <class S>
void addColumns(const SystemValues<S>& system, const std::vector<BodyMotion<S>>& motions, int body, int other,
                const Vec3<S>& place, const Vec3<S>& direction, std::vector<S>& row) {
  const int common = findCommonBody(system, body, other);
  for (int at = body; at != common; at = system.bodies[at].parent) {
    const Vec3<S> arm = place - motions[at].pose.origin;
    for (int k = 0; k < system.bodies[at].speed_count; ++k) {
      const Spatial<S>& column = motions[at].columns[k];
      S& entry = row[system.bodies[at].first_speed + k];
      entry = entry + dot(direction, column.linear + cross(column.angular, arm));
    }
  }
}

/// The acceleration of a body's point that speeds cause alone; `arm` from the body's origin, in ground axes.
template <class S>
Vec3<S> calcBiasAcceleration(const BodyMotion<S>& body, const Vec3<S>& arm) {
  const Vec3<S>& spin = body.velocity.angular;
  return body.bias.linear + cross(body.bias.angular, arm) + cross(spin, cross(spin, arm));
}

/// normal . (point - plane) = 0, with the normal fixed to the body `from`; the point's motion is seen from
/// there.
template <class S>
ClosureTerms<S> calcPlane(const SystemValues<S>& system, const Closure<S>& closure,
                          const std::vector<BodyMotion<S>>& motions) {
  const BodyMotion<S>& carrier = motions[closure.from.body];
  const PointMotion<S> point = calcPoint(motions[closure.to.body], closure.to.point);
  const Vec3<S> normal = carrier.pose.rotation * closure.normal;
  const Vec3<S> arm = point.place - carrier.pose.origin;
  const Vec3<S>& spin = carrier.velocity.angular;
  const Vec3<S> relative = point.velocity - (carrier.velocity.linear + cross(spin, arm));
  ClosureTerms<S> terms;
  terms.value = dot(normal, arm - carrier.pose.rotation * closure.from.point);
  terms.row.assign(system.coordinate_count, S(0.0));
  addColumns(system, motions, closure.to.body, closure.from.body, point.place, normal, terms.row);
  addColumns(system, motions, closure.from.body, closure.to.body, point.place, -normal, terms.row);
  terms.bias = dot(normal, calcBiasAcceleration(motions[closure.to.body], point.arm) -
                               calcBiasAcceleration(carrier, arm) - scale(S(2.0), cross(spin, relative)));
  return terms;
}

/// (distance^2 - length^2) / (2 length), which is a length and has no root.
template <class S>
ClosureTerms<S> calcRod(const SystemValues<S>& system, const Closure<S>& closure,
                        const std::vector<BodyMotion<S>>& motions) {
  const PointMotion<S> from = calcPoint(motions[closure.from.body], closure.from.point);
  const PointMotion<S> to = calcPoint(motions[closure.to.body], closure.to.point);
  const Vec3<S> between = to.place - from.place, rate = to.velocity - from.velocity;
  const S inverse = S(1.0) / closure.length;
  const Vec3<S> direction = scale(inverse, between);
  ClosureTerms<S> terms;
  terms.value = S(0.5) * (dot(direction, between) - closure.length);
  terms.row.assign(system.coordinate_count, S(0.0));
  addColumns(system, motions, closure.to.body, closure.from.body, to.place, direction, terms.row);
  addColumns(system, motions, closure.from.body, closure.to.body, from.place, -direction, terms.row);
  terms.bias = dot(direction, calcBiasAcceleration(motions[closure.to.body], to.arm) -
                                  calcBiasAcceleration(motions[closure.from.body], from.arm)) +
               inverse * dot(rate, rate);
  return terms;
}

/// Adds how fast `body` turns about `direction` for a unit of each speed of the joints that carry it but not
/// `other`.
template <class S>
void addTurns(const SystemValues<S>& system, const std::vector<BodyMotion<S>>& motions, int body, int other,
              const Vec3<S>& direction, std::vector<S>& row) {
  const int common = findCommonBody(system, body, other);
  for (int at = body; at != common; at = system.bodies[at].parent) {
    for (int k = 0; k < system.bodies[at].speed_count; ++k) {
      S& entry = row[system.bodies[at].first_speed + k];
      entry = entry + dot(direction, motions[at].columns[k].angular);
    }
  }
}

/// a . b = 0 of a vector a fixed to `from` and one b fixed to `to`: it changes by (b x a) . (spin of `to`
/// less that of `from`).
template <class S>
ClosureTerms<S> calcPerpendicular(const SystemValues<S>& system, const Closure<S>& closure,
                                  const std::vector<BodyMotion<S>>& motions) {
  const BodyMotion<S>&from = motions[closure.from.body], &to = motions[closure.to.body];
  const Vec3<S> a = from.pose.rotation * closure.normal, b = to.pose.rotation * closure.across;
  const Vec3<S> direction = cross(b, a);
  const Vec3<S>&from_spin = from.velocity.angular, &to_spin = to.velocity.angular;
  const Vec3<S> turn = cross(cross(to_spin, b), a) + cross(b, cross(from_spin, a));
  ClosureTerms<S> terms;
  terms.value = dot(a, b);
  terms.row.assign(system.coordinate_count, S(0.0));
  addTurns(system, motions, closure.to.body, closure.from.body, direction, terms.row);
  addTurns(system, motions, closure.from.body, closure.to.body, -direction, terms.row);
  terms.bias = dot(direction, to.bias.angular - from.bias.angular) + dot(turn, to_spin - from_spin);
  return terms;
}

/// Where what rolls touches its plane, in ground.
template <class S>
Vec3<S> calcTouch(const Closure<S>& closure, const std::vector<BodyMotion<S>>& motions) {
  const Vec3<S> normal = motions[closure.from.body].pose.rotation * closure.normal;
  return calcPoint(motions[closure.to.body], closure.to.point).place - scale(closure.length, normal);
}

/// direction . (velocity of `to` less that of `from`, both where they touch) = 0, with the direction fixed to
/// `from`. The touching point travels along both bodies as the center does.
template <class S>
ClosureTerms<S> calcRolling(const SystemValues<S>& system, const Closure<S>& closure,
                            const std::vector<BodyMotion<S>>& motions) {
  const BodyMotion<S>&from = motions[closure.from.body], &to = motions[closure.to.body];
  const Vec3<S>&from_spin = from.velocity.angular, &to_spin = to.velocity.angular;
  const Vec3<S> reach = scale(S(-closure.length), from.pose.rotation * closure.normal);  // from the center
  const Vec3<S> reach_rate = cross(from_spin, reach), direction = from.pose.rotation * closure.across;
  const PointMotion<S> center = calcPoint(to, closure.to.point);
  const Vec3<S> touch = center.place + reach, arm = touch - from.pose.origin;
  const Vec3<S> slip = center.velocity + cross(to_spin, reach) - from.velocity.linear - cross(from_spin, arm);
  const Vec3<S> of_wheel =
      calcBiasAcceleration(to, center.arm) + cross(to.bias.angular, reach) + cross(to_spin, reach_rate);
  const Vec3<S> of_plane = from.bias.linear + cross(from.bias.angular, arm) +
                           cross(from_spin, center.velocity + reach_rate - from.velocity.linear);
  ClosureTerms<S> terms;
  terms.value = 0.0;
  terms.row.assign(system.coordinate_count, S(0.0));
  addColumns(system, motions, closure.to.body, closure.from.body, touch, direction, terms.row);
  addColumns(system, motions, closure.from.body, closure.to.body, touch, -direction, terms.row);
  terms.bias = dot(direction, of_wheel - of_plane) + dot(cross(from_spin, direction), slip);
  return terms;
}

/// All conditions at the motions of the coordinates.
template <class S>
std::vector<ClosureTerms<S>> calcClosureTerms(const SystemValues<S>& system,
                                              const std::vector<BodyMotion<S>>& motions,
                                              const std::vector<S>& coordinates) {
  std::vector<ClosureTerms<S>> all;
  for (const Closure<S>& closure : system.closures) {
    switch (closure.kind) {
      case ClosureKind::kPlane:
        all.push_back(calcPlane(system, closure, motions));
        break;
      case ClosureKind::kRod:
        all.push_back(calcRod(system, closure, motions));
        break;
      case ClosureKind::kPerpendicular:
        all.push_back(calcPerpendicular(system, closure, motions));
        break;
      case ClosureKind::kRolling:
        all.push_back(calcRolling(system, closure, motions));
        break;
      case ClosureKind::kGear: {
        ClosureTerms<S> terms{
            coordinates[closure.coordinate] - closure.ratio * coordinates[closure.driver] - closure.offset,
            S(0.0), std::vector<S>(system.coordinate_count, S(0.0))};
        terms.row[closure.coordinate] = 1.0;
        terms.row[closure.driver] = -closure.ratio;
        all.push_back(std::move(terms));
      }
    }
  }
  return all;
}

}  // namespace twinmap::equations
