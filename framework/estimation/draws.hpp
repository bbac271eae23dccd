#pragma once

#include <Eigen/Core>

#include "framework/base/random/random.hpp"
#include "framework/estimation/estimate.hpp"

namespace twinmap {

/// Draws (p x n) from the normal distribution of covariance D R D, D = diag(stddev). `correlation`: R (p x
/// p), positive semi-definite.
Eigen::MatrixXd drawNormal(const Eigen::VectorXd& mean, const Eigen::VectorXd& stddev,
                           const Eigen::MatrixXd& correlation, int draws, const RandomStream& random);

/// Draws (p x n) from a mixture, or from an estimate: of its own draws, mixture or normal distribution.
Eigen::MatrixXd drawFrom(const Mixture& mixture, int draws, const RandomStream& random);
Eigen::MatrixXd drawFrom(const Estimate& estimate, int draws, const RandomStream& random);

}  // namespace twinmap
