#pragma once

#include <Eigen/Core>

namespace twinmap {

/// W with W C W' = 1 for a noise covariance C: differences of features to differences of unit noise.
class NoiseWhitener {
 public:
  /// `covariance`: d x d, positive semi-definite. W is the inverse of its Cholesky factor (k = d). Where C is
  /// singular, as that of features which repeat others, W keeps the k directions whose variance is above
  /// 1e-12 of the largest, each feature in units of its own noise. Throws std::invalid_argument for a feature
  /// without noise. Cost: d^3 / 3 flops, some 10 d^3 where C is singular.
  explicit NoiseWhitener(const Eigen::MatrixXd& covariance);

  const Eigen::MatrixXd& getMatrix() const { return matrix_; }  ///< W, k x d

  /// Differences (d x n) -> k x n.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& differences) const;

 private:
  Eigen::MatrixXd matrix_;
  bool diagonal_ = false;
};

}  // namespace twinmap
