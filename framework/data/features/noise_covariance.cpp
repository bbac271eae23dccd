#include "framework/data/features/noise_covariance.hpp"

#include <cmath>

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

NoiseCovariance NoiseCovariance::replace(const VectorXd& stddevs) const {
  NoiseCovariance replaced = *this;
  for (Index i = 0; i < stddevs.size(); ++i) {
    if (std::isnan(stddevs[i])) {
      continue;
    }
    replaced.variances_[i] = stddevs[i] * stddevs[i];
    if (!isDiagonal()) {
      replaced.matrix_.row(i).setZero();
      replaced.matrix_.col(i).setZero();
      replaced.matrix_(i, i) = replaced.variances_[i];
    }
  }
  return replaced.isDiagonal() ? replaced : NoiseCovariance(std::move(replaced.matrix_));
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
