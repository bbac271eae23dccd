#include "kernels/surrogate/left_out_density.hpp"

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void mirrorLower(MatrixXd& matrix) {
  for (Index j = 1; j < matrix.cols(); ++j) {
    matrix.col(j).head(j) = matrix.row(j).head(j).transpose();
  }
}

/// Replaces a symmetric positive definite matrix by its inverse; false if it is not.
bool invert(MatrixXd& matrix) {
  linalg::TriangularScratch scratch(matrix.rows());
  const linalg::View view = linalg::viewOf(matrix);
  if (!linalg::factorizeCholesky(view, scratch)) {
    return false;
  }
  linalg::invertLower(view, scratch);
  linalg::multiplyTransposedBySelf(view, scratch);
  mirrorLower(matrix);
  return true;
}

}  // namespace

LeftOutDensity::LeftOutDensity(const MatrixXd& points, const MatrixXd& values, SharedStructure structure)
    : points_(points),
      values_(values),
      structure_(structure),
      terms_(calcTerms(structure.trend, points).transpose()) {}

bool LeftOutDensity::calcPrecision(const SharedHyperparameters& hyperparameters) {
  calcSharedCovariance(structure_, hyperparameters, points_, covariance_, slopes_);
  precision_ = covariance_;
  if (!invert(precision_)) {
    return false;
  }
  const MatrixXd solved = precision_ * terms_;
  const linalg::Cholesky of_terms = linalg::calcCholesky(terms_.transpose() * solved);
  if (!of_terms.positive_definite) {
    return false;
  }
  const MatrixXd half = linalg::solveLower(of_terms.lower, solved.transpose());  // q x n
  precision_.noalias() -= half.transpose() * half;
  return precision_.diagonal().minCoeff() > 0.0;
}

double LeftOutDensity::calcDensity() {
  weights_.noalias() = precision_ * values_;
  left_out_.variance = precision_.diagonal().cwiseInverse();
  left_out_.residual = left_out_.variance.asDiagonal() * weights_;
  left_out_.amplitude = (weights_.array() * left_out_.residual.array()).colwise().mean().transpose();
  const auto total = 1.0 + (left_out_.variance * left_out_.amplitude.transpose()).array();
  return 0.5 * (total.log() + left_out_.residual.array().square() / total).sum();
}

void LeftOutDensity::calcGradient(const SharedHyperparameters& hyperparameters, VectorXd& gradient) {
  const Index n = points_.cols(), p = points_.rows();
  const ArrayXd variance = left_out_.variance.array();
  const auto residual = left_out_.residual.array();
  const Eigen::ArrayXXd total = 1.0 + (left_out_.variance * left_out_.amplitude.transpose()).array();
  const Eigen::ArrayXXd by_residual = residual / total;
  const Eigen::ArrayXXd by_total = 0.5 * (1.0 / total - by_residual.square());
  const ArrayXd by_amplitude =
      (by_total.colwise() * variance).colwise().sum().transpose() / static_cast<double>(n);
  // Derivatives with respect to a = P s and to the diagonal of P, of which e, the variance and t are
  // functions.
  const Eigen::ArrayXXd through_amplitude = residual.rowwise() * by_amplitude.transpose();
  const MatrixXd by_weights = (by_residual.colwise() * variance + 2.0 * through_amplitude).matrix();
  const ArrayXd of_total = (by_total.matrix() * left_out_.amplitude).array() * variance;
  const VectorXd by_diagonal = -(((by_residual * residual).rowwise().sum() + of_total) * variance +
                                 (through_amplitude * residual).rowwise().sum());
  // dP = -P dK P turns both into -tr(dK adjoint / 2), of which the symmetric part's lower half is enough.
  const MatrixXd by_precision = precision_ * by_weights;
  const MatrixXd twice = precision_ * (2.0 * by_diagonal).asDiagonal();
  adjoint_.resize(n, n);
  adjoint_.triangularView<Eigen::Lower>() = twice * precision_;
  adjoint_.triangularView<Eigen::Lower>() += weights_ * by_precision.transpose();
  adjoint_.triangularView<Eigen::Lower>() += by_precision * weights_.transpose();
  gradient.resize(p + 1);
  gradient(p) = -0.5 * hyperparameters.nugget * adjoint_.diagonal().sum();
  adjoint_.triangularView<Eigen::StrictlyLower>() = adjoint_.cwiseProduct(slopes_);
  for (Index v = 0; v < p; ++v) {
    const VectorXd x = points_.row(v).transpose() / hyperparameters.length_scales(v);
    double sum = 0.0;
    for (Index j = 0; j < n; ++j) {
      const Index below = n - j - 1;
      sum += (adjoint_.col(j).tail(below).array() * (x.tail(below).array() - x(j)).square()).sum();
    }
    gradient(v) = -sum;
  }
}

bool LeftOutDensity::evaluate(const SharedHyperparameters& hyperparameters, double& negative_log_density) {
  if (!calcPrecision(hyperparameters)) {
    return false;
  }
  negative_log_density = calcDensity();
  return std::isfinite(negative_log_density);
}

bool LeftOutDensity::evaluate(const SharedHyperparameters& hyperparameters, double& negative_log_density,
                              VectorXd& gradient) {
  if (!evaluate(hyperparameters, negative_log_density)) {
    return false;
  }
  calcGradient(hyperparameters, gradient);
  return gradient.allFinite();
}

}  // namespace twinmap::gp
