#include "framework/data/noise/noise_whitener.hpp"

#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NoiseWhitener::NoiseWhitener(const NoiseCovariance& covariance) {
  const VectorXd& variance = covariance.diagonal();
  if (variance.size() > 0 && !(variance.minCoeff() > 0.0)) {
    throw std::invalid_argument("the noise of a feature is 0");
  }
  scale_ = variance.cwiseSqrt().cwiseInverse();
  if (covariance.isDiagonal()) {
    return;
  }
  constexpr double kSmallest = 1e-12;
  const MatrixXd correlation = scale_.asDiagonal() * covariance.toMatrix() * scale_.asDiagonal();
  const linalg::Cholesky factor = linalg::calcCholesky(correlation);
  if (factor.reciprocal_condition > kSmallest) {
    matrix_ = linalg::solveLower(factor.lower, scale_.asDiagonal());
    return;
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(correlation);
  const VectorXd& values = eigen.values;
  const Index kept = (values.array() > kSmallest * values[values.size() - 1]).count();
  matrix_ = values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
            eigen.vectors.rightCols(kept).transpose() * scale_.asDiagonal();
}

MatrixXd NoiseWhitener::makeMatrix() const {
  return isDiagonal() ? MatrixXd(scale_.asDiagonal()) : matrix_;
}

MatrixXd NoiseWhitener::apply(const MatrixXd& differences) const {
  if (isDiagonal()) {
    return differences.array().colwise() * scale_.array();
  }
  return matrix_ * differences;
}

MatrixXd NoiseWhitener::applyTransposed(const MatrixXd& directions) const {
  if (isDiagonal()) {
    return directions.array().colwise() * scale_.array();
  }
  return matrix_.transpose() * directions;
}

}  // namespace twinmap
