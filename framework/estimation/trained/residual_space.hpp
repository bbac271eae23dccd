#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/data/features/noise_covariance.hpp"
#include "framework/estimation/surrogate/forward_surrogate.hpp"

namespace twinmap {

/// Features in units of their noise, parted into what the scores of a surrogate span, what else moves with
/// the parameters, and noise:
///   z = W (features - center),   scores = V' z,   unmodelled = U' z,
/// V and U orthonormal and orthogonal to each other. Immutable.
struct ResidualSpace {
  Eigen::MatrixXd whitener;           ///< W, k x d, W C W' = 1 for the noise covariance C; d x 1 if diagonal
  Eigen::MatrixXd directions;         ///< V, k x r
  Eigen::MatrixXd unmodelled;         ///< U, k x u: of components that the surrogate left out
  Eigen::VectorXd unmodelled_stddev;  ///< u, over the box, in noise standard deviations

  /// All that a point leaves of features (d) in k numbers that are independent and of unit variance if the
  /// model is right: V times the innovations of the scores (r), given; the unmodelled part, which the point
  /// does not predict, over its standard deviation with noise; and the noise beside both. The innovations
  /// come in the order of the windows, and those of a window stay within its features: neighbours in time
  /// remain neighbours. Cost: 4 k (r + u) flops.
  void calcResidual(const Eigen::VectorXd& centered, const Eigen::VectorXd& innovation,
                    Eigen::VectorXd& residual) const;
};

/// The residual space of a surrogate's features (infos: d), from the clean features (d x n) of its training
/// simulations and the covariance of their noise (d x d). The unmodelled part of each window of features is
/// found as its components are (fitForward). Throws std::invalid_argument for a feature without noise.
ResidualSpace fitResidualSpace(const std::vector<FeatureInfo>& infos, const Eigen::MatrixXd& clean_features,
                               const NoiseCovariance& noise_covariance, const ForwardSurrogate& surrogate);

}  // namespace twinmap
