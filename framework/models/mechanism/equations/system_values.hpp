#pragma once

#include <array>
#include <vector>

#include "framework/experiment/model/system_spec.hpp"
#include "framework/models/mechanism/equations/algebra.hpp"

namespace twinmap::equations {

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

template <class S>
struct StationValues {
  int body = 0;
  Vec3<S> point;
};

template <class S>
struct SpringValues {
  int coordinate;
  S stiffness, rest;
};
template <class S>
struct DamperValues {
  int coordinate;
  S damping;
};
template <class S>
struct TwoPointSpringValues {
  StationValues<S> from, to;
  S stiffness, rest_length;
};
template <class S>
struct TwoPointDamperValues {
  StationValues<S> from, to;
  S damping;
};
template <class S>
struct FramedBodyValues {
  int body;
  Transform<S> frame;
};
template <class S>
struct BushingValues {
  FramedBodyValues<S> from, to;
  std::vector<S> stiffness, damping;  ///< 6 each
};

template <class S>
struct SystemValues {
  Vec3<S> gravity;
  std::vector<BodyValues<S>> bodies;  ///< ground first
  std::vector<SpringValues<S>> springs;
  std::vector<DamperValues<S>> dampers;
  std::vector<TwoPointSpringValues<S>> two_point_springs;
  std::vector<TwoPointDamperValues<S>> two_point_dampers;
  std::vector<BushingValues<S>> bushings;
  std::vector<StationValues<S>> loaded;  ///< one for each applied force
  int coordinate_count = 0;
};

}  // namespace twinmap::equations
