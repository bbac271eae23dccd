#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The 95 % interval of a normal distribution is mean +- this many standard deviations.
constexpr double kNormal95 = 1.959963984540054;

/// Inferred parameters (p x n each): the mean and the standard deviation of a normal distribution.
struct Predictions {
  Eigen::MatrixXd mean;
  Eigen::MatrixXd stddev;
};

}  // namespace twinmap
