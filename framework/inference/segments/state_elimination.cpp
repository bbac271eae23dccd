#include "framework/inference/segments/state_elimination.hpp"

#include <cmath>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rotates `row` into the triangle above, so that its first s numbers vanish.
void rotateInto(RowMatrix& triangle, Eigen::RowVectorXd& row) {
  const Index s = triangle.rows();
  for (Index i = 0; i < s; ++i) {
    if (row[i] == 0.0) {
      continue;
    }
    const double length = std::hypot(triangle(i, i), row[i]);
    const double c = triangle(i, i) / length, d = row[i] / length;
    const Index rest = row.size() - i;
    const Eigen::RowVectorXd above = triangle.row(i).tail(rest);
    triangle.row(i).tail(rest) = c * above + d * row.tail(rest);
    row.tail(rest) = c * row.tail(rest) - d * above;
  }
}

}  // namespace

StateElimination eliminateState(const VectorXd& residual, const MatrixXd& by_state,
                                const MatrixXd& by_parameters, const StatePrior& prior) {
  const Index n = residual.size(), s = by_state.cols(), u = by_parameters.cols();
  RowMatrix triangle = RowMatrix::Zero(s, s + 1 + u);
  triangle.leftCols(s) = prior.precision.asDiagonal();
  triangle.col(s) = prior.precision.cwiseProduct(prior.ahead);
  const double here = residual.squaredNorm() + triangle.col(s).squaredNorm();
  StateElimination found;
  found.residual.resize(n);
  found.jacobian.resize(n, u);
  Eigen::RowVectorXd row(s + 1 + u);
  for (Index t = 0; t < n; ++t) {
    row << by_state.row(t), residual[t], by_parameters.row(t);
    rotateInto(triangle, row);
    found.residual[t] = row[s];
    found.jacobian.row(t) = row.tail(u);
  }
  const auto upper = triangle.leftCols(s).triangularView<Eigen::Upper>();
  found.step = upper.solve(triangle.col(s));
  found.slopes = -upper.solve(triangle.rightCols(u));
  const MatrixXd of_prior = upper.solve(MatrixXd::Identity(s, s));
  found.told = static_cast<double>(s) - (prior.precision.asDiagonal() * of_prior).squaredNorm();
  found.gain = here - found.residual.squaredNorm();
  return found;
}

}  // namespace twinmap
