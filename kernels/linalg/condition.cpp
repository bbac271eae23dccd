#include "kernels/linalg/condition.hpp"

#include <Eigen/Core>
#include <cmath>

#include "kernels/linalg/triangular.hpp"

namespace twinmap::linalg {
namespace {

constexpr int kHagerSteps = 5;  // it stops after two or three in practice

// x = (L L')^-1 x
void applyInverse(ConstView lower, Eigen::VectorXd& x) {
  solveLower(lower, x.data());
  solveLowerTransposed(lower, x.data());
}

// The largest column sum of |L| |L'|: at least the norm of L L', and equal to it for nonnegative factors.
double boundNorm(ConstView lower) {
  const Index n = lower.rows;
  Eigen::VectorXd row_weights = Eigen::VectorXd::Zero(n);
  for (Index j = 0; j < n; ++j) {
    double column_sum = 0.0;
    for (Index i = j; i < n; ++i) {
      column_sum += std::abs(lower(i, j));
    }
    for (Index i = j; i < n; ++i) {
      row_weights(i) += std::abs(lower(i, j)) * column_sum;
    }
  }
  return row_weights.maxCoeff();
}

double estimateInverseNorm(ConstView lower) {
  const Index n = lower.rows;
  Eigen::VectorXd x = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  double norm = 0.0;
  for (int step = 0; step < kHagerSteps; ++step) {
    applyInverse(lower, x);
    const double found = x.lpNorm<1>();
    if (found <= norm) {
      break;
    }
    norm = found;
    x = x.unaryExpr([](double value) { return value >= 0.0 ? 1.0 : -1.0; });
    applyInverse(lower, x);
    Index largest = 0;
    x.cwiseAbs().maxCoeff(&largest);
    x.setZero();
    x(largest) = 1.0;
  }
  return norm;
}

}  // namespace

double estimateCondition(ConstView lower) {
  if (lower.rows == 0) {
    return 1.0;
  }
  return boundNorm(lower) * estimateInverseNorm(lower);
}

}  // namespace twinmap::linalg
