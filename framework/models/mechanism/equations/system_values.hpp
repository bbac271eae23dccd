#pragma once

#include <utility>
#include <vector>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/system_spec.hpp"
#include "kernels/lanes/program/real.hpp"

namespace twinmap::equations {

using namespace algebra;

/// The numbers of a system over a scalar, as SystemSpec describes them; bodies by index, ground is 0. SI
/// units.
template <class S>
struct BodyValues {
  int parent = 0;
  JointType type = JointType::kWeld;
  Vec3<S> axis;  ///< of joints that have one, a unit vector
  S pitch = 0.0;
  Transform<S> in_parent, in_body;  ///< joint frames
  S mass = 0.0;
  Vec3<S> center;       ///< of mass, in the body's frame
  Mat33<S> inertia;     ///< about the body's origin, in the body's frame
  int first_speed = 0;  ///< of its coordinates and speeds, which are as many
  int speed_count = 0;
};

enum class ClosureKind { kPlane, kRod, kGear, kPerpendicular, kRolling };

/// One condition c(q) = 0 of a constraint; those of coincident points are three planes. That of rolling in a
/// direction is of the speeds alone: no condition of the coordinates stands behind it.
template <class S>
struct Closure {
  ClosureKind kind = ClosureKind::kGear;
  int constraint = -1;      ///< its place in the file
  bool swapped = false;     ///< `from` and `to` are the file's `to` and `from`
  Station<S> from{}, to{};  ///< kPlane: a point of the plane, and the point that stays in it
  Vec3<S> normal{};         ///< of the plane, a unit vector in the frame of from's body
  Vec3<S> across{};         ///< kPerpendicular: a unit vector of to's body, at right angles to `normal`;
                            ///< kRolling: of from's body, the direction without slip
  S length = 1.0;           ///< of a rod; kRolling: the radius
  int coordinate = -1, driver = -1;  ///< kGear: coordinate = ratio * driver + offset
  S ratio = 0.0, offset = 0.0;
};

template <class S>
struct SystemValues {
  Vec3<S> gravity;
  std::vector<BodyValues<S>> bodies;  ///< ground first
  ForceElements<S> elements;
  std::vector<Closure<S>> closures;         ///< independent of each other
  std::vector<std::pair<int, S>> armature;  ///< coordinates and their own inertias
  int coordinate_count = 0;
  int state_count = 0;  ///< of first order
};

}  // namespace twinmap::equations
