#include "framework/features/noise_whitener.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <stdexcept>

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
  const Eigen::LLT<MatrixXd> factor(correlation);
  if (factor.info() == Eigen::Success && factor.rcond() > kSmallest) {
    matrix_ = factor.matrixL().solve(MatrixXd(scale.asDiagonal()));
    return;
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(correlation);
  const VectorXd& values = eigen.eigenvalues();  // increasing
  const Index kept = (values.array() > kSmallest * values[values.size() - 1]).count();
  matrix_ = values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
            eigen.eigenvectors().rightCols(kept).transpose() * scale.asDiagonal();
}

MatrixXd NoiseWhitener::apply(const MatrixXd& differences) const {
  if (diagonal_) {
    return differences.array().colwise() * matrix_.diagonal().array();
  }
  return matrix_ * differences;
}

}  // namespace twinmap
