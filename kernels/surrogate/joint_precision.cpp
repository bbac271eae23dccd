#include "kernels/surrogate/joint_precision.hpp"

#include <utility>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd mirror(MatrixXd lower) {
  lower.triangularView<Eigen::StrictlyUpper>() = lower.transpose();
  return lower;
}

/// False if the matrix, of which the lower triangle is read, is not positive definite.
bool invertSymmetric(const MatrixXd& matrix, MatrixXd& inverse) {
  inverse = matrix;
  linalg::TriangularScratch scratch(inverse.rows());
  const linalg::View view = linalg::viewOf(inverse);
  if (!linalg::factorizeCholesky(view, scratch)) {
    return false;
  }
  linalg::invertLower(view, scratch);
  linalg::multiplyTransposedBySelf(view, scratch);
  inverse = mirror(std::move(inverse));
  return true;
}

}  // namespace

/// What is left where some rows are left out.
struct JointPrecision::Part {
  std::vector<Index> rows, left_out;
  MatrixXd taken;   ///< of A_SS, its products with itself: G = L_FF^-1 A_FS; f x k
  MatrixXd factor;  ///< L_FF, lower: of A_FF
  MatrixXd terms;   ///< H', k x q
  bool definite = true;

  /// K_SS^-1 right_S, from A right for all rows: (A right)_S - A_SF A_FF^-1 (A right)_F, whatever right_F is.
  MatrixXd solve(const MatrixXd& product) const {
    MatrixXd solved = product(rows, Eigen::all);
    if (!left_out.empty()) {
      solved -= taken.transpose() * linalg::solveLower(factor, product(left_out, Eigen::all));
    }
    return solved;
  }
  /// Zeros for the rows left out.
  MatrixXd pad(const MatrixXd& kept, Index count) const {
    MatrixXd padded = MatrixXd::Zero(count, kept.cols());
    padded(rows, Eigen::all) = kept;
    return padded;
  }
};

JointPrecision::JointPrecision(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                               const MatrixXd& points, Index slope_points, Index variables)
    : length_scales_(hyperparameters.length_scales),
      points_(points.cols()),
      slope_points_(slope_points),
      variables_(variables),
      covariance_(mirror(calcJointCovariance(structure, hyperparameters, points, slope_points, variables))),
      terms_(calcJointTerms(structure.trend, length_scales_, points, slope_points, variables)) {
  definite_ = invertSymmetric(covariance_, precision_);
  if (definite_) {
    solved_terms_ = precision_ * terms_;
  }
}

std::vector<Index> JointPrecision::listRows(const std::vector<Index>& points) const {
  std::vector<Index> rows(points);
  for (Index v = 0; v < variables_; ++v) {
    for (const Index i : points) {
      if (i < slope_points_) {
        rows.push_back(points_ + v * slope_points_ + i);
      }
    }
  }
  return rows;
}

JointPrecision::Part JointPrecision::take(const std::vector<Index>& kept) const {
  std::vector<Index> left_out;
  for (Index i = 0, next = 0; i < points_; ++i) {
    if (next < static_cast<Index>(kept.size()) && kept[static_cast<std::size_t>(next)] == i) {
      ++next;
    } else {
      left_out.push_back(i);
    }
  }
  Part part;
  part.rows = listRows(kept);
  part.left_out = listRows(left_out);
  part.terms = terms_(part.rows, Eigen::all);
  part.taken.resize(0, static_cast<Index>(part.rows.size()));
  if (!left_out.empty()) {
    linalg::Cholesky of_others = linalg::calcCholesky(precision_(part.left_out, part.left_out));
    part.definite = of_others.positive_definite;
    part.taken = linalg::solveLower(of_others.lower, precision_(part.left_out, part.rows));
    part.factor = std::move(of_others.lower);
  }
  return part;
}

bool JointPrecision::fitPoints(const std::vector<Index>& kept, const MatrixXd& values,
                               const SlopeData& slopes, JointFit& fit) const {
  if (!definite_) {
    return false;
  }
  const Part part = take(kept);
  const Index count = precision_.rows();
  const MatrixXd solved = part.solve(solved_terms_);
  const linalg::Cholesky of_terms = linalg::calcCholesky(part.terms.transpose() * solved);
  if (!part.definite || !of_terms.positive_definite) {
    return false;
  }
  const MatrixXd known = stackValues(values, slopes, length_scales_);
  fit.coefficients.setZero(part.terms.cols(), values.cols());
  fit.weights.setZero(known.rows(), values.cols());
  const auto add = [&](const MatrixXd& rest) {
    const MatrixXd step = linalg::solveCholesky(of_terms.lower, solved.transpose() * rest);
    fit.weights += part.solve(precision_ * part.pad(rest, count)) - solved * step;
    fit.coefficients += step;
  };
  add(known);
  const MatrixXd covered = covariance_ * part.pad(fit.weights, count);
  add(known - covered(part.rows, Eigen::all) - part.terms * fit.coefficients);
  fit.residual.resize(values.rows(), values.cols());
  fit.variance.resize(values.rows());
  const MatrixXd of_trend = linalg::solveLower(of_terms.lower, solved.transpose());
  for (Index i = 0; i < values.rows(); ++i) {
    const std::vector<Index> rows = listJointRows(i, values.rows(), slopes);
    const MatrixXd taken = part.taken(Eigen::all, rows), trend = of_trend(Eigen::all, rows);
    std::vector<Index> among_all;
    for (const Index row : rows) {
      among_all.push_back(part.rows[static_cast<std::size_t>(row)]);
    }
    leaveOut(i, rows,
             precision_(among_all, among_all) - taken.transpose() * taken - trend.transpose() * trend, fit);
  }
  return fit.variance.minCoeff() > 0.0 && fit.weights.allFinite() && fit.residual.allFinite();
}

}  // namespace twinmap::gp
