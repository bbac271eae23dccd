#pragma once

#include <Eigen/Core>

#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// What every sample of a simulator is simulated with, besides its model. What it refers to must outlive it.
struct SampleTask {
  const ResponseLayout& layout;
  /// The equilibrium (coordinates, then states of first order) that all samples start from, or empty.
  const Eigen::VectorXd& box_center;
};

}  // namespace twinmap
