#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/inverse_map/mixture.hpp"

namespace twinmap {

/// The 95 % interval of a normal distribution is mean +- this many standard deviations.
constexpr double kNormal95 = 1.959963984540054;

/// Inferred parameters of n samples (p x n each): the mean and the standard deviation of a normal
/// distribution, or of a mixture.
struct Predictions {
  Eigen::MatrixXd mean;
  Eigen::MatrixXd stddev;
  /// p x p, of each sample's errors, where the map tells them apart; else empty.
  std::vector<Eigen::MatrixXd> correlations{};
  /// Of each sample, where the map gives mixtures; else empty.
  std::vector<Mixture> mixtures{};
};

/// In other units, as convert() of a mixture; the mean and standard deviation of a mixture follow from it.
void convert(const Eigen::VectorXd& center, const Eigen::VectorXd& unit, const Eigen::VectorXd& stddev_scale,
             Predictions& predictions);

/// The correlation matrix of a covariance (p x p, positive diagonal).
Eigen::MatrixXd calcCorrelation(const Eigen::MatrixXd& covariance);

}  // namespace twinmap
