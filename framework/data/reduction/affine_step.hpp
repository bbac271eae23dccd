#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/noise_covariance.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// x -> P (x - offset) / scale, the division element by element; without P where it is empty.
struct AffineStep {
  Eigen::VectorXd offset;      ///< d
  Eigen::VectorXd scale;       ///< d, > 0
  Eigen::MatrixXd projection;  ///< P, k x d, or empty

  /// k, or d without P.
  Eigen::Index countInputs() const { return projection.size() > 0 ? projection.rows() : offset.size(); }

  /// d x n -> k x n (or d x n).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& features) const;

  /// Differences of features (d x n) -> differences of inputs: P x / scale.
  Eigen::MatrixXd applyLinear(const Eigen::MatrixXd& differences) const;

  /// Covariance of features (d x d) -> of inputs (k x k).
  NoiseCovariance applyToCovariance(const NoiseCovariance& covariance) const;
};

/// x -> P (x - offset).
AffineStep makeProjection(const Eigen::VectorXd& offset, const Eigen::MatrixXd& projection);

/// Keeps the `selected` of `count` features, in that order.
AffineStep makeSelection(const std::vector<Eigen::Index>& selected, Eigen::Index count);

/// Offset is the mean, scale the standard deviation (1/(n-1)) of the features (d x n, n >= 2); a constant
/// feature has scale 1, so that it says nothing instead of NaN.
AffineStep fitZScore(const Eigen::MatrixXd& features);

/// Makes noise of covariance C (d x d) unit noise. By stddev: scale is the noise's standard deviation. By
/// covariance: W with W C W' = 1 (NoiseWhitener), which is the same where the noise is independent. Throws
/// std::invalid_argument for a feature without noise.
AffineStep fitWhiten(const WhitenSpec& spec, const NoiseCovariance& noise_covariance);

}  // namespace twinmap
