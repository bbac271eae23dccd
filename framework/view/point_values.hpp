#pragma once

#include <vector>

#include "framework/models/mechanism/equations/calc_system_values.hpp"
#include "framework/simulation/model_numbers.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// A system's numbers at a point of its parameters.
struct PointValues {
  /// `model` must outlive it.
  PointValues(const ModelSpec& model, const Eigen::VectorXd& point);

  SystemNames names;
  ModelNumbers numbers;
  equations::SystemValues<double> values;
};

/// Of all bodies, ground first.
std::vector<Pose> calcPoses(const equations::SystemValues<double>& values,
                            const std::vector<double>& coordinates);

}  // namespace twinmap::view
