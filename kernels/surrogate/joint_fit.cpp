#include "kernels/surrogate/joint_fit.hpp"

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// L^-1 in the lower triangle, zeros above; false if the matrix is not positive definite.
bool invertFactor(MatrixXd& matrix) {
  linalg::TriangularScratch scratch(matrix.rows());
  const linalg::View view = linalg::viewOf(matrix);
  if (!linalg::factorizeCholesky(view, scratch)) {
    return false;
  }
  linalg::invertLower(view, scratch);
  return true;
}

/// `inverse`: L^-1. `of_terms` (q x rows): its products with itself are what the trend takes from K^-1.
void leaveOutAll(const MatrixXd& inverse, const MatrixXd& of_terms, const SlopeData& slopes, JointFit& fit) {
  const Index n = fit.residual.rows();
  for (Index i = 0; i < n; ++i) {
    const std::vector<Index> rows = listJointRows(i, n, slopes);
    const Index below = inverse.rows() - i;
    const MatrixXd columns = inverse(Eigen::all, rows).bottomRows(below);
    const MatrixXd taken = of_terms(Eigen::all, rows);
    leaveOut(i, rows, columns.transpose() * columns - taken.transpose() * taken, fit);
  }
}

}  // namespace

MatrixXd stackValues(const MatrixXd& values, const SlopeData& slopes, const VectorXd& length_scales) {
  const Index n = values.rows(), m = slopes.countPoints();
  MatrixXd stacked(n + slopes.variables * m, values.cols());
  stacked.topRows(n) = values;
  for (Index v = 0; v < slopes.variables; ++v) {
    stacked.middleRows(n + v * m, m) = length_scales(v) * slopes.values.middleRows(v * m, m);
  }
  return stacked;
}

std::vector<Index> listJointRows(Index point, Index points, const SlopeData& slopes) {
  std::vector<Index> rows{point};
  for (Index v = 0; v < slopes.variables && point < slopes.countPoints(); ++v) {
    rows.push_back(points + v * slopes.countPoints() + point);
  }
  return rows;
}

void leaveOut(Index point, const std::vector<Index>& rows, const MatrixXd& block, JointFit& fit) {
  const VectorXd first =
      linalg::solvePositiveDefinite(block, VectorXd::Unit(static_cast<Index>(rows.size()), 0));
  fit.variance(point) = first(0);
  fit.residual.row(point) = first.transpose() * fit.weights(rows, Eigen::all);
}

bool fitJointly(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                const MatrixXd& points, const MatrixXd& values, const SlopeData& slopes, JointFit& fit) {
  const Index m = slopes.countPoints(), u = slopes.variables;
  MatrixXd inverse = calcJointCovariance(structure, hyperparameters, points, m, u);
  if (!invertFactor(inverse)) {
    return false;
  }
  const auto whiten = inverse.triangularView<Eigen::Lower>();
  const auto whiten_transposed = inverse.transpose().triangularView<Eigen::Upper>();
  const MatrixXd terms =
      whiten * calcJointTerms(structure.trend, hyperparameters.length_scales, points, m, u);
  const MatrixXd known = whiten * stackValues(values, slopes, hyperparameters.length_scales);
  fit.coefficients = linalg::fitLinear(terms, known).coefficients;
  const MatrixXd rest = known - terms * fit.coefficients;
  fit.weights = whiten_transposed * rest;
  const linalg::Cholesky of_terms = linalg::calcCholesky(terms.transpose() * terms);
  if (!of_terms.positive_definite || !fit.weights.allFinite()) {
    return false;
  }
  fit.residual.resize(points.cols(), values.cols());
  fit.variance.resize(points.cols());
  const MatrixXd solved = whiten_transposed * terms;
  leaveOutAll(inverse, linalg::solveLower(of_terms.lower, solved.transpose()), slopes, fit);
  return fit.variance.minCoeff() > 0.0 && fit.residual.allFinite();
}

double calcLeftOutDensity(const JointFit& fit) {
  const VectorXd amplitude =
      (fit.residual.array().square().colwise() / fit.variance.array()).colwise().mean().transpose();
  const Eigen::ArrayXXd total = 1.0 + (fit.variance * amplitude.transpose()).array();
  return 0.5 * (total.log() + fit.residual.array().square() / total).sum();
}

}  // namespace twinmap::gp
