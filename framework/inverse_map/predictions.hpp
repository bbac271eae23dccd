#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The 95 % interval of a normal distribution is mean +- this many standard deviations.
constexpr double kNormal95 = 1.959963984540054;

/// Inferred parameters of n samples (p x n each): the mean and the standard deviation of a normal
/// distribution.
struct Predictions {
  Eigen::MatrixXd mean;
  Eigen::MatrixXd stddev;
  /// p x p, of each sample's errors, where the map tells them apart; else empty.
  std::vector<Eigen::MatrixXd> correlations{};
};

/// The correlation matrix of a covariance (p x p, positive diagonal).
Eigen::MatrixXd calcCorrelation(const Eigen::MatrixXd& covariance);

}  // namespace twinmap
