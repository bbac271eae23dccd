#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/tree.hpp"

namespace twinmap::equations {

/// Below this distance (m) two points have no direction between them, and exert no force on each other.
constexpr double kCoincident = 1e-12;

/// Forces on bodies (moment and force at their origins, in ground axes; ground first) and on speeds, and the
/// rates of the states of first order.
template <class S>
struct Loads {
  std::vector<Spatial<S>> on_bodies;
  std::vector<S> on_speeds, state_rates;
};

/// None yet. `bodies`: with ground.
template <class S>
Loads<S> makeLoads(std::size_t bodies, std::size_t speeds, std::size_t states) {
  return {std::vector<Spatial<S>>(bodies), std::vector<S>(speeds, S(0.0)), std::vector<S>(states, S(0.0))};
}

/// What one element exerts, for outputs of its force.
template <class S>
struct Exerted {
  S along = 0.0;          ///< on its coordinate; the pull between its points; the pressure on its plane
  Vec3<S> force, moment;  ///< on its body, or that of `to`, where it acts; in ground axes
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

/// How a station moves against a plane: the depth behind it and its rate, the slip in the plane as the
/// plane's body sees it, the normal in ground axes, and where the station is from each body's origin.
template <class S>
struct PlaneMotion {
  S depth, rate;
  Vec3<S> slip, normal, arm, plane_arm;
};

template <class S>
PlaneMotion<S> calcOnPlane(const std::vector<BodyMotion<S>>& motions, const Station<S>& station,
                           const Plane<S>& plane) {
  using namespace program::real;
  const PointMotion<S> point = calcPoint(motions[station.body], station.point);
  const BodyMotion<S>& base = motions[plane.body];
  const S length = sqrt(dot(plane.normal, plane.normal));
  const Vec3<S> normal = base.pose.rotation * scale(S(S(1.0) / length), plane.normal);
  const Vec3<S> arm = point.place - base.pose.origin;
  const Vec3<S> velocity = point.velocity - base.velocity.linear - cross(base.velocity.angular, arm);
  const S depth = dot(normal, base.pose.rotation * plane.point - arm), rate = -dot(normal, velocity);
  return {depth, rate, velocity + scale(rate, normal), normal, point.arm, arm};
}

/// Body-fixed x-y-z angles of a rotation, the middle one within +-90 degrees.
template <class S>
Vec3<S> calcAngles(const Mat33<S>& r) {
  using namespace program::real;
  return {atan2(-r.z.y, r.z.z), atan2(r.z.x, sqrt(r.x.x * r.x.x + r.y.x * r.y.x)), atan2(-r.y.x, r.x.x)};
}

/// What the laws of force elements see of a state, and where they add their forces: addForces(element, sum).
/// `Named` evaluates what varies: its calc(expression) gives an S at the state. No memory is allocated.
template <class S, class Named>
class ForceSum {
 public:
  /// All must outlive the sum. `rates`: time derivatives of the coordinates; `states`: of first order;
  /// `modes`: of switches, or null where they are not known.
  ForceSum(const std::vector<BodyMotion<S>>& motions, const std::vector<S>& coordinates,
           const std::vector<S>& rates, const std::vector<S>& states, const Named& named, Loads<S>& loads,
           const std::vector<S>* modes = nullptr)
      : motions_(motions),
        coordinates_(coordinates),
        rates_(rates),
        states_(states),
        named_(named),
        loads_(loads),
        modes_(modes) {}

  const S& getCoordinate(int coordinate) const { return coordinates_[coordinate]; }
  const S& getRate(int coordinate) const { return rates_[coordinate]; }
  const S& getState(int state) const { return states_[state]; }
  /// Of a coordinate and another, or nothing; and of their rates.
  S calcDifference(int coordinate, const std::optional<int>& against) const {
    return against ? S(coordinates_[coordinate] - coordinates_[*against]) : coordinates_[coordinate];
  }
  S calcSlip(int coordinate, const std::optional<int>& against) const {
    return against ? S(rates_[coordinate] - rates_[*against]) : rates_[coordinate];
  }
  /// `level` with the sign of a mode, which is -1, 0 or 1; 0 where modes are not known.
  S calcSided(int mode, const S& level) const {
    using namespace program::real;
    if (modes_ == nullptr || modes_->empty()) {
      return S(0.0);
    }
    const S& side = (*modes_)[mode];
    return select(equal(side, S(1.0)), level, select(equal(side, S(-1.0)), S(-level), S(0.0)));
  }
  /// 1 while something touches, else 0: by its mode, or where modes are not known by its depth.
  S calcTouching(int mode, const S& depth) const {
    using namespace program::real;
    return modes_ == nullptr || modes_->empty() ? less(S(0.0), depth) : (*modes_)[mode];
  }
  S calc(const Expression& expression) const { return named_.calc(expression); }
  S calc(const StateNumber<S>& number) const {
    return number.varying != nullptr ? named_.calc(*number.varying) : number.value;
  }
  /// Components in ground axes.
  Vec3<S> calcInGround(const Expression3& components, ForceFrame frame, int body) const {
    const Vec3<S> value{calc(components[0]), calc(components[1]), calc(components[2])};
    return frame == ForceFrame::kBody ? motions_[body].pose.rotation * value : value;
  }
  /// From the body's origin to the station, in ground axes.
  Vec3<S> calcArm(const Station<S>& station) const {
    return motions_[station.body].pose.rotation * station.point;
  }

  /// What the element exerts whose law was called since the last takeExerted().
  Exerted<S> takeExerted() {
    on_coordinate_ = false;
    return std::exchange(exerted_, {});
  }

  void addAt(int body, const Vec3<S>& arm, const Vec3<S>& force) {
    exerted_.force = force;
    loads_.on_bodies[body] = loads_.on_bodies[body] + Spatial<S>{cross(arm, force), force};
  }
  void addMoment(int body, const Vec3<S>& moment) {
    exerted_.moment = moment;
    loads_.on_bodies[body].angular = loads_.on_bodies[body].angular + moment;
  }
  /// The first coordinate is the element's own, another what it acts against.
  void addOnCoordinate(int coordinate, const S& force) {
    if (!on_coordinate_) {
      exerted_.along = force;
      on_coordinate_ = true;
    }
    loads_.on_speeds[coordinate] = loads_.on_speeds[coordinate] + force;
  }

  void addBetween(int coordinate, const std::optional<int>& against, const S& force) {
    addOnCoordinate(coordinate, force);
    if (against) {
      addOnCoordinate(*against, -force);
    }
  }

  void setStateRate(int state, const S& rate) { loads_.state_rates[state] = rate; }

  void addGravity(int body, const Vec3<S>& gravity, const S& mass, const Vec3<S>& center) {
    addAt(body, motions_[body].pose.rotation * center, scale(mass, gravity));
  }

  /// Pulls two stations together by `tension(distance, rate)`.
  template <class Tension>
  void addPull(const Station<S>& from, const Station<S>& to, Tension tension) {
    using namespace program::real;
    const PointMotion<S> first = calcPoint(motions_[from.body], from.point);
    const PointMotion<S> second = calcPoint(motions_[to.body], to.point);
    const Vec3<S> between = second.place - first.place;
    const S zero = 0.0, one = 1.0;
    const S squared = dot(between, between);
    const S apart = lessOrEqual(S(kCoincident * kCoincident), squared);
    const S distance = sqrt(select(apart, squared, one));  // 1 in place of 0, whose root has no derivative
    const S inverse = select(apart, one / distance, zero);
    const Vec3<S> direction = scale(inverse, between);
    exerted_.along = tension(distance, dot(second.velocity - first.velocity, direction));
    const Vec3<S> pull = scale(exerted_.along, direction);
    addAt(from.body, first.arm, pull);
    addAt(to.body, second.arm, -pull);
  }

  /// Presses a station off a plane by `law(depth, rate, slip)`: the force along the normal, and in the plane.
  /// `slip`: the velocity of the station in the plane, as its body sees it.
  template <class Law>
  void addOnPlane(const Station<S>& station, const Plane<S>& plane, Law law) {
    const PlaneMotion<S> at = calcOnPlane(motions_, station, plane);
    const auto [pressure, in_plane] = law(at.depth, at.rate, at.slip);
    const Vec3<S> force = scale(pressure, at.normal) + in_plane;
    addAt(plane.body, at.plane_arm, -force);
    addAt(station.body, at.arm, force);
    exerted_.along = pressure;
  }

  /// Acts on `to`, and against it on `from`, by `law(direction, q, q')` along each of the relative
  /// coordinates of `to` in `from`: body-fixed x-y-z angles (directions 0 to 2), then translations (3 to 5).
  template <class Law>
  void addBetweenFrames(const AttachedFrame<S>& from, const AttachedFrame<S>& to, Law law) {
    const BodyMotion<S>&from_body = motions_[from.body], &to_body = motions_[to.body];
    const Transform<S> from_frame = from_body.pose * from.frame, to_frame = to_body.pose * to.frame;
    const Transform<S> relative = invert(from_frame) * to_frame;
    const Mat33<S> back = transpose(from_frame.rotation);
    const Vec3<S> to_arm = to_frame.origin - to_body.pose.origin;
    const Vec3<S> from_arm = to_frame.origin - from_body.pose.origin;
    const Vec3<S> at_point = to_body.velocity.linear + cross(to_body.velocity.angular, to_arm);
    const Vec3<S> carried = from_body.velocity.linear + cross(from_body.velocity.angular, from_arm);
    const auto calcForces = [&law](int first, const Vec3<S>& q, const Vec3<S>& rate) {
      return Vec3<S>{law(first, q.x, rate.x), law(first + 1, q.y, rate.y), law(first + 2, q.z, rate.z)};
    };
    const Vec3<S> angles = calcAngles(relative.rotation);
    const Mat33<S> rates = calcAngleRates(angles);
    const Vec3<S> spin = rates * (back * (to_body.velocity.angular - from_body.velocity.angular));
    // virtual power: torque . angular velocity = angle forces . angle rates, so torque = N' * angle forces
    const Vec3<S> torque = from_frame.rotation * (transpose(rates) * calcForces(0, angles, spin));
    const Vec3<S> force = from_frame.rotation * calcForces(3, relative.origin, back * (at_point - carried));
    addAt(from.body, from_arm, -force);
    addAt(to.body, to_arm, force);
    addMoment(from.body, -torque);
    addMoment(to.body, torque);
  }

 private:
  const std::vector<BodyMotion<S>>& motions_;
  const std::vector<S>&coordinates_, &rates_, &states_;
  const Named& named_;
  Loads<S>& loads_;
  const std::vector<S>* modes_;
  Exerted<S> exerted_;
  bool on_coordinate_ = false;
};

/// The forces of all elements, kind by kind.
template <class S, class Named>
void addElementForces(const ForceElements<S>& elements, ForceSum<S, Named>& sum) {
  elements.forEachList([&sum](const auto& list) {
    for (const auto& element : list) {
      addForces(element, sum);
    }
  });
}

/// The rates of the states that are not elements' own.
template <class S, class Named>
void setStateRates(const std::vector<StateSpec>& states, const Named& named, Loads<S>& loads) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    loads.state_rates[i] = named.calc(states[i].derivative);
  }
}

}  // namespace twinmap::equations
