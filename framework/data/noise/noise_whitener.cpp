#include "framework/data/noise/noise_whitener.hpp"

#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NoiseWhitener::NoiseWhitener(const MatrixXd& covariance) {
  const VectorXd variance = covariance.diagonal();
  if (variance.size() > 0 && !(variance.minCoeff() > 0.0)) {
    throw std::invalid_argument("the noise of a feature is 0");
  }
  const VectorXd scale = variance.cwiseSqrt().cwiseInverse();
  diagonal_ = covariance.isDiagonal(0.0);
  if (diagonal_) {
    matrix_ = scale.asDiagonal();
    return;
  }
  constexpr double kSmallest = 1e-12;
  const MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const linalg::Cholesky factor = linalg::calcCholesky(correlation);
  if (factor.reciprocal_condition > kSmallest) {
    matrix_ = linalg::solveLower(factor.lower, scale.asDiagonal());
    return;
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(correlation);
  const VectorXd& values = eigen.values;
  const Index kept = (values.array() > kSmallest * values[values.size() - 1]).count();
  matrix_ = values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
            eigen.vectors.rightCols(kept).transpose() * scale.asDiagonal();
}

MatrixXd NoiseWhitener::apply(const MatrixXd& differences) const {
  if (diagonal_) {
    return differences.array().colwise() * matrix_.diagonal().array();
  }
  return matrix_ * differences;
}

}  // namespace twinmap
