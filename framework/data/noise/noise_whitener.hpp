#pragma once

#include <Eigen/Core>

#include "framework/data/features/noise_covariance.hpp"

namespace twinmap {

/// W with W C W' = 1 for a noise covariance C: differences of features to differences of unit noise.
class NoiseWhitener {
 public:
  /// `covariance`: d x d, positive semi-definite. W is the inverse of its Cholesky factor (k = d). Where C is
  /// singular, as that of features which repeat others, W keeps the k directions whose variance is above
  /// 1e-12 of the largest, each feature in units of its own noise. Throws std::invalid_argument for a feature
  /// without noise. Cost: d where C is diagonal, else d^3 / 3 flops, some 10 d^3 where C is singular.
  explicit NoiseWhitener(const NoiseCovariance& covariance);

  Eigen::Index countDirections() const { return matrix_.size() > 0 ? matrix_.rows() : scale_.size(); }  ///< k
  bool isDiagonal() const { return matrix_.size() == 0; }
  const Eigen::VectorXd& getScale() const { return scale_; }  ///< 1 / standard deviation of each feature
  Eigen::MatrixXd makeMatrix() const;                         ///< W, k x d; d^2 numbers

  /// Differences (d x n) -> k x n.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& differences) const;
  /// W' directions, k x n -> d x n.
  Eigen::MatrixXd applyTransposed(const Eigen::MatrixXd& directions) const;

 private:
  Eigen::VectorXd scale_;
  Eigen::MatrixXd matrix_;  // empty where it is diagonal
};

}  // namespace twinmap
