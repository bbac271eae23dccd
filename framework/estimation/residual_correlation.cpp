#include "framework/estimation/residual_correlation.hpp"

#include <algorithm>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

Eigen::MatrixXd makePositiveDefinite(const Eigen::MatrixXd& correlation) {
  constexpr double kMinEigenvalue = 1e-6;
  const double least = linalg::calcSymmetricEigenvalues(correlation)[0];
  const double weight = std::max(0.0, (kMinEigenvalue - least) / (1.0 - least));
  Eigen::MatrixXd shrunk = (1.0 - weight) * correlation;
  shrunk.diagonal().setOnes();
  return shrunk;
}

}  // namespace

Eigen::MatrixXd calcResidualCorrelation(const Eigen::MatrixXd& standardised_residuals) {
  const Eigen::VectorXd norms = standardised_residuals.rowwise().norm();
  const Eigen::VectorXd inverse = (norms.array() > 0.0).select(norms.cwiseInverse(), 0.0);
  const Eigen::MatrixXd unit = inverse.asDiagonal() * standardised_residuals;
  Eigen::MatrixXd correlation = unit * unit.transpose();
  correlation.diagonal().setOnes();
  return correlation.rows() < 2 ? correlation : makePositiveDefinite(correlation);
}

}  // namespace twinmap
