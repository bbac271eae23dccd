#pragma once

#include <vector>

#include "framework/models/mechanism/equations/system_values.hpp"

namespace twinmap::equations {

/// A joint at its coordinates and speeds, in the joint frame of the parent: the frame of the body in it, the
/// velocity for a unit of each speed, and the acceleration that speeds cause alone. Speeds are Simbody's: the
/// derivatives of the coordinates, but for ball and free joints angular and linear velocity in the parent's
/// frame.
template <class S>
struct JointMotion {
  Transform<S> frame;
  std::vector<Spatial<S>> columns;
  Spatial<S> bias;
};

/// Columns of body-fixed x-y-z angle rates.
template <class S>
std::vector<Spatial<S>> calcAngleColumns(const Vec3<S>& angles) {
  const Mat33<S> first = rotateX(angles.x), second = first * rotateY(angles.y);
  return {{{1.0, 0.0, 0.0}, {}}, {first.y, {}}, {second.z, {}}};
}

/// The angular acceleration of three successive rotations at constant rates.
template <class S>
Vec3<S> calcAngleBias(const std::vector<Spatial<S>>& columns, const S* u) {
  const Vec3<S> first = scale(u[0], columns[0].angular), second = scale(u[1], columns[1].angular),
                third = scale(u[2], columns[2].angular);
  return cross(first, second) + cross(first + second, third);
}

template <class S>
void appendTranslations(JointMotion<S>& motion) {
  motion.columns.push_back({{}, {1.0, 0.0, 0.0}});
  motion.columns.push_back({{}, {0.0, 1.0, 0.0}});
  motion.columns.push_back({{}, {0.0, 0.0, 1.0}});
}

/// Joints with an axis: pin, slider, screw, cylinder.
template <class S>
JointMotion<S> calcAxisJoint(const BodyValues<S>& body, const S* q) {
  const Vec3<S>& axis = body.axis;
  switch (body.type) {
    case JointType::kSlider:
      return {{makeDiagonal(S(1.0)), scale(q[0], axis)}, {{{}, axis}}, {}};
    case JointType::kPin:
      return {{rotateAbout(axis, q[0]), {}}, {{axis, {}}}, {}};
    case JointType::kScrew:
      return {
          {rotateAbout(axis, q[0]), scale(body.pitch * q[0], axis)}, {{axis, scale(body.pitch, axis)}}, {}};
    default:
      return {{rotateAbout(axis, q[0]), scale(q[1], axis)}, {{axis, {}}, {{}, axis}}, {}};
  }
}

template <class S>
JointMotion<S> calcUniversal(const S* q, const S* u) {
  const Mat33<S> first = rotateX(q[0]);
  const Vec3<S> x{1.0, 0.0, 0.0};
  return {{first * rotateY(q[1]), {}},
          {{x, {}}, {first.y, {}}},
          {cross(scale(u[0], x), scale(u[1], first.y)), {}}};
}

/// Polar coordinates in the plane of x and y, with the Coriolis and centripetal accelerations.
template <class S>
JointMotion<S> calcBendStretch(const S* q, const S* u) {
  const Mat33<S> turn = rotateZ(q[0]);
  const Vec3<S> z{0.0, 0.0, 1.0};
  const Vec3<S> bias = scale(S(2.0) * u[0] * u[1], turn.y) - scale(u[0] * u[0] * q[1], turn.x);
  return {{turn, scale(q[1], turn.x)}, {{z, scale(q[1], turn.y)}, {{}, turn.x}}, {{}, bias}};
}

template <class S>
JointMotion<S> calcPlanar(const S* q) {
  return {{rotateZ(q[0]), {q[1], q[2], 0.0}},
          {{{0.0, 0.0, 1.0}, {}}, {{}, {1.0, 0.0, 0.0}}, {{}, {0.0, 1.0, 0.0}}},
          {}};
}

/// Three angles, then three translations or none; speeds are angle rates or the angular velocity.
template <class S>
JointMotion<S> calcAngleJoint(const BodyValues<S>& body, const S* q, const S* u) {
  const Vec3<S> angles{q[0], q[1], q[2]};
  JointMotion<S> motion{{rotateXyz(angles), {}}, {}, {}};
  if (hasAngularVelocity(body.type)) {
    motion.columns = {{{1.0, 0.0, 0.0}, {}}, {{0.0, 1.0, 0.0}, {}}, {{0.0, 0.0, 1.0}, {}}};
  } else {
    motion.columns = calcAngleColumns(angles);
    motion.bias.angular = calcAngleBias(motion.columns, u);
  }
  if (body.speed_count == 6) {
    motion.frame.origin = {q[3], q[4], q[5]};
    appendTranslations(motion);
  }
  return motion;
}

template <class S>
JointMotion<S> calcTranslation(const S* q) {
  JointMotion<S> motion{{makeDiagonal(S(1.0)), {q[0], q[1], q[2]}}, {}, {}};
  appendTranslations(motion);
  return motion;
}

/// `q`, `u`: the joint's own coordinates and speeds.
template <class S>
JointMotion<S> calcJoint(const BodyValues<S>& body, const S* q, const S* u) {
  switch (body.type) {
    case JointType::kWeld:
      return {};
    case JointType::kSlider:
    case JointType::kPin:
    case JointType::kScrew:
    case JointType::kCylinder:
      return calcAxisJoint(body, q);
    case JointType::kUniversal:
      return calcUniversal(q, u);
    case JointType::kBendStretch:
      return calcBendStretch(q, u);
    case JointType::kPlanar:
      return calcPlanar(q);
    case JointType::kTranslation:
      return calcTranslation(q);
    case JointType::kGimbal:
    case JointType::kBall:
    case JointType::kBushing:
    case JointType::kFree:
      return calcAngleJoint(body, q, u);
  }
  return {};
}

/// N and its inverse in (body-fixed x-y-z angles)' = N * angular velocity in the first frame; N is singular
/// where cos(angles.y) = 0.
template <class S>
Mat33<S> calcAngleRates(const Vec3<S>& angles) {
  using namespace program::real;
  const S s0 = sin(angles.x), c0 = cos(angles.x), s1 = sin(angles.y), c1 = cos(angles.y);
  return {{1.0, 0.0, 0.0}, {s0 * s1 / c1, c0, -s0 / c1}, {-c0 * s1 / c1, s0, c0 / c1}};
}
template <class S>
Mat33<S> calcAngularVelocities(const Vec3<S>& angles) {
  const std::vector<Spatial<S>> columns = calcAngleColumns(angles);
  return {columns[0].angular, columns[1].angular, columns[2].angular};
}

/// Where three of the values belong to a ball or free joint, multiplies them by `matrix` of the joint's
/// angles.
template <class S, class Matrix>
std::vector<S> convertAngles(const SystemValues<S>& system, const std::vector<S>& q, std::vector<S> values,
                             Matrix matrix) {
  for (const BodyValues<S>& body : system.bodies) {
    if (hasAngularVelocity(body.type)) {
      const int i = body.first_speed;
      const Vec3<S> own =
          matrix(Vec3<S>{q[i], q[i + 1], q[i + 2]}) * Vec3<S>{values[i], values[i + 1], values[i + 2]};
      values[i] = own.x;
      values[i + 1] = own.y;
      values[i + 2] = own.z;
    }
  }
  return values;
}

/// Time derivatives of the coordinates from speeds, and back.
template <class S>
std::vector<S> calcRates(const SystemValues<S>& system, const std::vector<S>& q, const std::vector<S>& u) {
  return convertAngles(system, q, u, [](const Vec3<S>& angles) { return calcAngleRates(angles); });
}
template <class S>
std::vector<S> calcSpeeds(const SystemValues<S>& system, const std::vector<S>& q,
                          const std::vector<S>& rates) {
  return convertAngles(system, q, rates, [](const Vec3<S>& angles) { return calcAngularVelocities(angles); });
}

/// Second time derivatives of the coordinates from their first ones and the accelerations of the speeds: with
/// w = E(angles) angles', angles'' = E^-1 (w' - E' angles').
template <class S>
std::vector<S> calcSecondRates(const SystemValues<S>& system, const std::vector<S>& q,
                               const std::vector<S>& rates, std::vector<S> accelerations) {
  for (const BodyValues<S>& body : system.bodies) {
    if (hasAngularVelocity(body.type)) {
      const int i = body.first_speed;
      const Vec3<S> bias = calcAngleBias(calcAngleColumns(Vec3<S>{q[i], q[i + 1], q[i + 2]}), &rates[i]);
      accelerations[i] = accelerations[i] - bias.x;
      accelerations[i + 1] = accelerations[i + 1] - bias.y;
      accelerations[i + 2] = accelerations[i + 2] - bias.z;
    }
  }
  return calcRates(system, q, accelerations);
}

}  // namespace twinmap::equations
