#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/noise_covariance.hpp"

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

}  // namespace twinmap
