#include "framework/models/mechanism/simbody/forces.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::Mat33;
using SimTK::Rotation;
using SimTK::Transform;
using SimTK::Vec3;

/// Pose and velocity of frame `to` in frame `from`, all in the axes of `from`.
struct RelativeMotion {
  Transform from_in_ground;
  Vec3 point_in_ground;  ///< origin of `to`
  Vec3 angles, translation;
  Vec3 angular_velocity, velocity;
};

RelativeMotion calcRelativeMotion(const Bushing& bushing, const ForceSum& sum) {
  const SimTK::State& state = sum.getState();
  const SimTK::MobilizedBody& from = sum.getBody(bushing.from.body);
  const SimTK::MobilizedBody& to = sum.getBody(bushing.to.body);
  RelativeMotion motion;
  motion.from_in_ground = from.getBodyTransform(state) * toTransform(bushing.from.frame);
  const Transform to_in_ground = to.getBodyTransform(state) * toTransform(bushing.to.frame);
  motion.point_in_ground = to_in_ground.p();
  const Transform relative = ~motion.from_in_ground * to_in_ground;
  motion.angles = relative.R().convertRotationToBodyFixedXYZ();
  motion.translation = relative.p();
  const Vec3 at_point = to.findStationVelocityInGround(state, toVec3(bushing.to.frame.point));
  const Vec3 carried =
      from.findStationVelocityInGround(state, ~from.getBodyTransform(state) * motion.point_in_ground);
  const Vec3 spin = to.getBodyAngularVelocity(state) - from.getBodyAngularVelocity(state);
  motion.velocity = ~motion.from_in_ground.R() * (at_point - carried);
  motion.angular_velocity = ~motion.from_in_ground.R() * spin;
  return motion;
}

/// N of (body-fixed x-y-z angles)' = N * angular velocity in the first frame; singular where cos(angles[1]) =
/// 0.
Mat33 calcAngleRates(const Vec3& angles) {
  const double s0 = std::sin(angles[0]), c0 = std::cos(angles[0]);
  const double c1 = std::cos(angles[1]), t1 = std::tan(angles[1]);
  return Mat33(1.0, s0 * t1, -c0 * t1,  //
               0.0, c0, s0,             //
               0.0, -s0 / c1, c0 / c1);
}

Vec3 calcResistance(const Bushing& bushing, int first, const Vec3& coordinates, const Vec3& rates) {
  Vec3 force;
  for (int i = 0; i < 3; ++i) {
    force[i] = -bushing.stiffness[first + i] * coordinates[i] - bushing.damping[first + i] * rates[i];
  }
  return force;
}

}  // namespace

void addBushing(const Bushing& bushing, ForceSum& sum) {
  const RelativeMotion motion = calcRelativeMotion(bushing, sum);
  const Mat33 rates = calcAngleRates(motion.angles);
  // virtual power: torque . angular velocity = angle forces . angle rates, so torque = N' * angle forces
  const Vec3 angle_forces = calcResistance(bushing, 0, motion.angles, rates * motion.angular_velocity);
  const Rotation& axes = motion.from_in_ground.R();
  const Vec3 torque = axes * (~rates * angle_forces);
  const Vec3 force = axes * calcResistance(bushing, 3, motion.translation, motion.velocity);
  const SimTK::Transform& from = sum.getBody(bushing.from.body).getBodyTransform(sum.getState());
  sum.addForce(bushing.to.body, toVec3(bushing.to.frame.point), force);
  sum.addForce(bushing.from.body, ~from * motion.point_in_ground, -force);
  sum.addMoment(bushing.to.body, torque);
  sum.addMoment(bushing.from.body, -torque);
}

}  // namespace twinmap
