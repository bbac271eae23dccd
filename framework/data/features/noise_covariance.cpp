#include "framework/data/features/noise_covariance.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void NoiseCovariance::setMatrix(MatrixXd matrix) {
  variances_ = matrix.diagonal();
  if (!matrix.isDiagonal(0.0)) {
    matrix_ = std::move(matrix);
  }
}

NoiseCovariance NoiseCovariance::makeIndependent(VectorXd variances) {
  NoiseCovariance covariance;
  covariance.variances_ = std::move(variances);
  return covariance;
}

VectorXd NoiseCovariance::col(Index feature) const {
  return isDiagonal() ? VectorXd(variances_[feature] * VectorXd::Unit(size(), feature))
                      : VectorXd(matrix_.col(feature));
}

NoiseCovariance NoiseCovariance::take(const std::vector<Index>& features) const {
  return isDiagonal() ? makeIndependent(variances_(features)) : NoiseCovariance(matrix_(features, features));
}

MatrixXd NoiseCovariance::operator*(const MatrixXd& right) const {
  return isDiagonal() ? MatrixXd(variances_.asDiagonal() * right) : MatrixXd(matrix_ * right);
}

MatrixXd NoiseCovariance::toMatrix() const {
  return isDiagonal() ? MatrixXd(variances_.asDiagonal()) : matrix_;
}

}  // namespace twinmap
