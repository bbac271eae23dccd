#pragma once

#include <array>

#include "framework/models/mechanism/system_numbers.hpp"

namespace twinmap {

struct CoordinateSpring {
  int coordinate;
  double stiffness, rest;
};
struct CoordinateDamper {
  int coordinate;
  double damping;
};
struct TwoPointSpring {
  Station from, to;
  double stiffness, rest_length;
};
struct TwoPointDamper {
  Station from, to;
  double damping;
};
struct FramedBody {
  int body;
  FrameNumbers frame;
};
struct Bushing {
  FramedBody from, to;
  std::array<double, 6> stiffness, damping;
};

/// The forces that depend on the state only: gravity, springs, dampers, bushings.
struct PassiveForces {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  std::vector<CoordinateSpring> springs;
  std::vector<CoordinateDamper> dampers;
  std::vector<TwoPointSpring> two_point_springs;
  std::vector<TwoPointDamper> two_point_dampers;
  std::vector<Bushing> bushings;
};

Station calcAppliedStation(const AppliedForceSpec& force, const SystemNames& names, NumberEvaluator& numbers);

/// Throws ExperimentError also for a spring or damper on a coordinate that takes no forces.
PassiveForces calcPassiveForces(const SystemSpec& spec, const SystemNames& names, NumberEvaluator& numbers);

}  // namespace twinmap
