#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// How far and how fast a coordinate moves on which forces may act, and what forces move it.
struct CoordinateSizes {
  std::string name;
  bool is_angle = false;
  double reach = 0.0;       ///< max |q|, m or rad
  double speed = 0.0;       ///< max |q'|
  double force = 0.0;       ///< of the size of inertia times rms q'', N or N m
  double gravity = 0.0;     ///< largest force of gravity on it
  bool is_weighed = false;  ///< whether that force varies
};

/// The largest |x|, of the trial where it is largest and of the one where it is least.
struct Extent {
  double largest = 0.0, least = 0.0;
};

/// The sizes of a model at a point: how large a term must be to matter.
struct ModelSizes {
  std::vector<CoordinateSizes> coordinates;  ///< those that move
  std::vector<double> masses;                ///< of the bodies, kg
  std::vector<double> lengths;      ///< of a body: its centre of mass from its frame, or its gyradius, m
  std::vector<double> moments;      ///< of a body: its largest moment of inertia, kg m2
  double mass = 0.0, moment = 0.0;  ///< of all bodies together
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  std::vector<Extent> outputs, signals;
  /// rms of each of the experiment's candidates with a coefficient of 1, for each value of its scale
  std::vector<std::vector<double>> own_forces;
};

/// From one simulation at a point of the sampled box. Throws std::runtime_error where that fails.
ModelSizes calcModelSizes(const ExperimentSpec& experiment, const Eigen::VectorXd& point);

}  // namespace twinmap
