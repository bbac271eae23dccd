#pragma once

#include <Eigen/Core>

namespace twinmap {

/// Inferred parameters (p x n each): the mean and the standard deviation of a normal distribution.
struct Predictions {
  Eigen::MatrixXd mean;
  Eigen::MatrixXd stddev;
};

}  // namespace twinmap
