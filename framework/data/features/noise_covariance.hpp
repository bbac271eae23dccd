#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The covariance of the noise of d features. Of independent noise only the variances are stored, so that
/// memory and time grow with d; of other noise d x d numbers.
class NoiseCovariance {
 public:
  NoiseCovariance() = default;
  /// A symmetric d x d matrix. Where it is diagonal, its variances alone are kept.
  template <class Derived>
  NoiseCovariance(const Eigen::EigenBase<Derived>& matrix) {
    setMatrix(matrix);
  }
  /// Of independent noise.
  static NoiseCovariance makeIndependent(Eigen::VectorXd variances);

  Eigen::Index size() const { return variances_.size(); }
  bool isDiagonal() const { return matrix_.size() == 0; }
  const Eigen::VectorXd& diagonal() const { return variances_; }
  Eigen::VectorXd col(Eigen::Index feature) const;
  double operator()(Eigen::Index row, Eigen::Index column) const {
    return isDiagonal() ? (row == column ? variances_[row] : 0.0) : matrix_(row, column);
  }

  /// With these standard deviations (d) where they are numbers, independent of all else; NaN: as it is.
  NoiseCovariance replace(const Eigen::VectorXd& stddevs) const;
  /// That of some features (ascending).
  NoiseCovariance take(const std::vector<Eigen::Index>& features) const;
  /// C right, d x n.
  Eigen::MatrixXd operator*(const Eigen::MatrixXd& right) const;
  Eigen::MatrixXd toMatrix() const;

 private:
  void setMatrix(Eigen::MatrixXd matrix);

  Eigen::VectorXd variances_;
  Eigen::MatrixXd matrix_;  // empty where it is diagonal
};

}  // namespace twinmap
