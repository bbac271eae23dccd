#pragma once

#include <Eigen/Core>

#include "kernels/gp/online/process_view.hpp"

namespace twinmap {

/// How the noise of a parameter varies with the inputs of its process.
///
/// The likelihood's noise variance is one number, but the noise of a parameter is that of its features,
/// carried through the slope of the map: steep places are uncertain. To first order its variance is the
/// mean's squared slope along the noise of the inputs (McHutchon and Rasmussen, Gaussian Process Training
/// with Input Noise, 2011). So the likelihood's variance, which is right on average, is multiplied by
///   s(x) / mean of s over the training inputs,   s(x) = |L' dm/dx|^2,
/// L = `directions`, at least by kSmallestFactor.
struct NoiseProfile {
  static constexpr double kSmallestFactor = 0.1;

  Eigen::MatrixXd directions;  ///< k x r, L with L L' = noise covariance of the inputs; empty: constant noise
  Eigen::VectorXd mean_of_slope;  ///< p, mean of s over the training inputs, standardised parameters

  bool isConstant() const { return directions.size() == 0; }

  /// The factor of parameter p's noise variance at each of `inputs` (k x n). Cost: that of a gradient of the
  /// mean.
  Eigen::ArrayXd calcFactors(const gp::Process& process, Eigen::Index parameter,
                             const Eigen::MatrixXd& inputs) const;
};

/// s at each of `inputs`.
Eigen::ArrayXd calcSquaredSlopes(const gp::Process& process, const Eigen::MatrixXd& directions,
                                 const Eigen::MatrixXd& inputs);

/// A profile for trained processes. `inputs`: k x n, the training inputs of one draw of the noise;
/// `noise_covariance`: of the first of their rows, the others being known without noise. Directions without
/// noise are left out.
NoiseProfile fitNoiseProfile(const std::vector<gp::Process>& processes,
                             const Eigen::MatrixXd& noise_covariance, const Eigen::MatrixXd& inputs);

}  // namespace twinmap
