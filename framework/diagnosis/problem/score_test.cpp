#include "framework/diagnosis/problem/score_test.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of two terms: the share of the squared length of one that is left beside the other.
constexpr double kDistinct = 1e-3;

VectorXd calcLengths(const MatrixXd& columns) {
  return columns.colwise().norm().transpose().unaryExpr([](double x) { return x > 0.0 ? x : 1.0; });
}

/// A process x_t = rho x_(t-1) + e_t, within a sequence.
struct Autoregression {
  double rho = 0.0, stddev = 1.0;  ///< of e
};

/// Of residuals; rho only where it is above three standard errors, and no variance below that stated.
Autoregression fitAutoregression(const Eigen::Ref<const VectorXd>& residual) {
  const Index n = residual.size();
  const double squares = residual.squaredNorm();
  double rho = squares > 0.0 ? residual.tail(n - 1).dot(residual.head(n - 1)) / squares : 0.0;
  if (std::abs(rho) * std::sqrt(static_cast<double>(n)) < 3.0) {
    rho = 0.0;
  }
  const double variance = squares / static_cast<double>(n) * (1.0 - rho * rho);
  return {rho, std::sqrt(std::max(1.0 - rho * rho, variance))};
}

/// To e / sd, each column for itself; the first one as the process has it at any time.
void whiten(const Autoregression& process, Eigen::Ref<MatrixXd> columns) {
  const Index n = columns.rows();
  const MatrixXd before = columns.topRows(n - 1);
  columns.row(0) *= std::sqrt(1.0 - process.rho * process.rho);
  columns.bottomRows(n - 1) -= process.rho * before;
  columns /= process.stddev;
}

}  // namespace

ScoreTest::ScoreTest(const VectorXd& residual, const MatrixXd& jacobian, const MatrixXd& terms)
    : jacobian_(jacobian * calcLengths(jacobian).cwiseInverse().asDiagonal()),
      lengths_(calcLengths(jacobian)),
      given_(terms) {
  MatrixXd right(terms.rows(), terms.cols() + 1);
  right << residual, terms;
  const MatrixXd coefficients = linalg::fitLinear(jacobian_, right).coefficients;
  right -= jacobian_ * coefficients;
  residual_ = right.col(0);
  terms_ = right.rightCols(terms.cols());
  taken_up_ = lengths_.cwiseInverse().asDiagonal() * coefficients.rightCols(terms.cols());
}

TermScore ScoreTest::calcScore(Index term, double size) const {
  TermScore score;
  const double whole = given_.col(term).norm(), kept = terms_.col(term).norm();
  if (!(whole * size > kImmaterial) || !(kept * kept > kSameNumber * whole * whole)) {
    return score;
  }
  score.visible = true;
  score.stddev = 1.0 / kept;
  score.estimate = terms_.col(term).dot(residual_) / (kept * kept);
  score.z = score.estimate / score.stddev;
  score.shifts = calcShifts(term, score.estimate);
  return score;
}

ScoreTest::JointScore ScoreTest::calcJointScore(const std::vector<Index>& terms) const {
  const MatrixXd columns = terms_(Eigen::all, terms);
  const MatrixXd gram = columns.transpose() * columns;
  const VectorXd lengths = gram.diagonal().cwiseSqrt();
  const VectorXd right = columns.transpose() * residual_;
  const MatrixXd cosines = lengths.cwiseInverse().asDiagonal() * gram * lengths.cwiseInverse().asDiagonal();
  JointScore score;
  const auto k = static_cast<Index>(terms.size());
  for (Index i = 0; i < k; ++i) {
    for (Index j = 0; j < i; ++j) {
      if (!(1.0 - cosines(i, j) * cosines(i, j) > kDistinct)) {
        return score;
      }
    }
  }
  const linalg::Cholesky factor = linalg::calcCholesky(gram);
  score.estimates = linalg::solveCholesky(factor.lower, right);
  score.stddevs = factor.lower.diagonal().cwiseInverse();
  score.gain = right.dot(score.estimates);
  score.shifts = VectorXd::Zero(taken_up_.rows());
  for (Index i = 0; i < k; ++i) {
    score.shifts += calcShifts(terms[static_cast<std::size_t>(i)], score.estimates[i]);
  }
  return score;
}

MatrixXd ScoreTest::calcPairGains() const {
  const MatrixXd gram = terms_.transpose() * terms_;
  const VectorXd right = terms_.transpose() * residual_;
  const Index k = terms_.cols();
  MatrixXd gains = MatrixXd::Zero(k, k);
  for (Index j = 0; j < k; ++j) {
    for (Index i = 0; i < j; ++i) {
      const double product = gram(i, i) * gram(j, j), distinct = product - gram(i, j) * gram(i, j);
      if (distinct > kDistinct * product) {
        gains(i, j) = (right[i] * right[i] * gram(j, j) - 2.0 * right[i] * right[j] * gram(i, j) +
                       right[j] * right[j] * gram(i, i)) /
                      distinct;
      }
    }
  }
  return gains;
}

double ScoreTest::calcLikeness(Index a, Index b) const {
  const double lengths = terms_.col(a).norm() * terms_.col(b).norm();
  return lengths > 0.0 ? std::abs(terms_.col(a).dot(terms_.col(b))) / lengths : 0.0;
}

double ScoreTest::calcCautiousStddev(Index term, const std::vector<Index>& starts) const {
  const Index n = residual_.size(), u = jacobian_.cols();
  const VectorXd direction = terms_.col(term);
  const VectorXd remains = residual_ - direction * (direction.dot(residual_) / direction.squaredNorm());
  MatrixXd columns(n, u + 1);
  columns << direction, jacobian_;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const Index first = starts[s], count = (s + 1 < starts.size() ? starts[s + 1] : n) - first;
    whiten(fitAutoregression(remains.segment(first, count)), columns.middleRows(first, count));
  }
  const VectorXd right = columns.col(0);
  const MatrixXd parameters = columns.rightCols(u);
  return 1.0 / (right - parameters * linalg::fitLinear(parameters, right).coefficients).norm();
}

double calcPValue(double z, int tests) {
  return std::min(1.0, tests * std::erfc(std::abs(z) / std::sqrt(2.0)));
}

double calcPairPValue(double gain, double tests) {
  return std::min(1.0, tests * std::exp(-0.5 * gain));  // chi-square of two degrees of freedom
}

double calcCriticalZ(double level, int tests) {
  return std::sqrt(2.0) * boost::math::erfc_inv(level / std::max(1, tests));
}

double calcLogEvidence(double gain, double stddev, double size) {
  const double ratio = size * size / (stddev * stddev);
  return 0.5 * gain * ratio / (1.0 + ratio) - 0.5 * std::log1p(ratio);
}

double calcLogEvidence(double gain, const SizedCoefficient& coefficient) {
  // nine decades, as coefficients on a motor's side of a gear are a millionth of what matters; half a decade
  // apart, so that their normal distributions merge into one smooth prior
  constexpr int kSizes = 19;
  const double variance = coefficient.stddev * coefficient.stddev;
  const double square = coefficient.estimate * coefficient.estimate;
  double size = std::max(coefficient.size, std::abs(coefficient.estimate));
  double sum = 0.0;
  for (int i = 0; i < kSizes; ++i, size /= std::sqrt(10.0)) {
    const double wide = variance + size * size;
    // none of them vanishes: the first is at least as wide as the estimate
    sum += std::exp(-0.5 * square / wide) * std::sqrt(variance / wide);
  }
  return 0.5 * gain + std::log(sum / kSizes);
}

}  // namespace twinmap
