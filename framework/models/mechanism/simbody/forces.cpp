#include "framework/models/mechanism/simbody/forces.hpp"

#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::MobilizedBody;
using SimTK::State;
using SimTK::Vec3;

/// Below this distance (m) two points have no direction between them, and exert no force on each other.
constexpr double kCoincident = 1e-12;

void addGravity(const Vec3& gravity, ForceSum& sum) {
  const int bodies = sum.getTree().getMatter().getNumBodies();
  for (int i = 1; i < bodies && gravity.normSqr() > 0.0; ++i) {
    const SimTK::SpatialInertia& inertia = sum.getBody(i).getBodySpatialInertiaInGround(sum.getState());
    sum.addAt(i, inertia.getMassCenter(), inertia.getMass() * gravity);
  }
}

/// Two stations, seen from the first: the unit vector to the second, the distance and its rate.
struct Pair {
  Vec3 direction;
  double distance, rate;
};

Pair calcPair(const Station& from, const Station& to, const ForceSum& sum) {
  Vec3 from_point, from_velocity, to_point, to_velocity;
  sum.getBody(from.body).findStationLocationAndVelocityInGround(sum.getState(), toVec3(from.point),
                                                                from_point, from_velocity);
  sum.getBody(to.body).findStationLocationAndVelocityInGround(sum.getState(), toVec3(to.point), to_point,
                                                              to_velocity);
  const Vec3 between = to_point - from_point;
  const double distance = between.norm();
  if (distance < kCoincident) {
    return {Vec3(0.0), distance, 0.0};
  }
  const Vec3 direction = between / distance;
  return {direction, distance, SimTK::dot(to_velocity - from_velocity, direction)};
}

void addPull(const Station& from, const Station& to, const Vec3& pull, ForceSum& sum) {
  sum.addForce(from.body, toVec3(from.point), pull);
  sum.addForce(to.body, toVec3(to.point), -pull);
}

}  // namespace

void ForceSum::addForce(int body, const Vec3& point, const Vec3& force) {
  addAt(body, getBody(body).expressVectorInGroundFrame(state_, point), force);
}

void ForceSum::addAt(int body, const Vec3& arm, const Vec3& force) {
  forces_.on_bodies[body] += SimTK::SpatialVec(SimTK::cross(arm, force), force);
}

void addPassiveForces(const PassiveForces& forces, ForceSum& sum) {
  const State& state = sum.getState();
  const std::vector<BodyTree::Slot>& slots = sum.getTree().getSlots();
  addGravity(toVec3(forces.gravity), sum);
  for (const CoordinateSpring& spring : forces.springs) {
    const double stretch = state.getQ()[slots[spring.coordinate].q] - spring.rest;
    sum.addOnCoordinate(spring.coordinate, -spring.stiffness * stretch);
  }
  for (const CoordinateDamper& damper : forces.dampers) {
    sum.addOnCoordinate(damper.coordinate, -damper.damping * state.getU()[slots[damper.coordinate].u]);
  }
  for (const TwoPointSpring& spring : forces.two_point_springs) {
    const Pair pair = calcPair(spring.from, spring.to, sum);
    const double tension = spring.stiffness * (pair.distance - spring.rest_length);
    addPull(spring.from, spring.to, tension * pair.direction, sum);
  }
  for (const TwoPointDamper& damper : forces.two_point_dampers) {
    const Pair pair = calcPair(damper.from, damper.to, sum);
    addPull(damper.from, damper.to, damper.damping * pair.rate * pair.direction, sum);
  }
  for (const Bushing& bushing : forces.bushings) {
    addBushing(bushing, sum);
  }
}

}  // namespace twinmap
