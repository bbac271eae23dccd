#include "kernels/surrogate/box_moments.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kUniformPrecision = 3.0;  // of a variable that is uniform on [-1, 1]

struct Scalar {
  double mean, variance;
};

/// Of exp(-q x^2 / 2 + b x) on [-1, 1], q >= 0, by Simpson's rule where it is not negligible.
Scalar calcIntervalMoments(double q, double b) {
  constexpr int kIntervals = 64;
  constexpr double kReach = 16.0;  // widths of the normal or the exponential that it is near its mode
  const double mode = q > 0.0 ? std::clamp(b / q, -1.0, 1.0) : (b > 0.0 ? 1.0 : -1.0);
  const double slope = std::abs(b - q * mode);
  const double width = 1.0 / std::max({slope, std::sqrt(q), 1e-3});
  const double lower = std::max(-1.0, mode - kReach * width), upper = std::min(1.0, mode + kReach * width);
  const double step = (upper - lower) / kIntervals;
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double d = lower + i * step - mode;
    const double weight = (i == 0 || i == kIntervals) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    const double density = weight * std::exp((b - q * mode) * d - 0.5 * q * d * d);
    sum += density;
    first += density * d;
    second += density * d * d;
  }
  const double mean = first / sum;
  return {mode + mean, second / sum - mean * mean};
}

/// The normal factors that stand for the bounds, and what follows.
struct Factors {
  VectorXd precision, shift;
  Moments moments;
};

void update(const MatrixXd& precision, const VectorXd& shift, Factors& factors) {
  MatrixXd total = precision;
  total.diagonal() += factors.precision;
  factors.moments.covariance = linalg::solveCholesky(linalg::calcCholesky(total).lower,
                                                     MatrixXd::Identity(shift.size(), shift.size()));
  factors.moments.mean = factors.moments.covariance * (shift + factors.shift);
}

/// Improves the factor of one variable; returns how much its moments moved, in standard deviations.
double refine(Index k, Factors& factors) {
  constexpr double kLeastPrecision = 1e-9;
  const double variance = factors.moments.covariance(k, k), mean = factors.moments.mean(k);
  const double q = std::max(1.0 / variance - factors.precision(k), 0.0);
  const double b = mean / variance - factors.shift(k);
  const Scalar found = calcIntervalMoments(q, b);
  factors.precision(k) = std::max(1.0 / found.variance - q, kLeastPrecision);
  factors.shift(k) = found.mean / found.variance - b;
  return std::abs(found.mean - mean) / std::sqrt(variance) + std::abs(found.variance / variance - 1.0);
}

}  // namespace

Moments calcBoxMoments(const MatrixXd& precision, const VectorXd& shift) {
  constexpr int kMostSweeps = 20;
  constexpr double kTolerance = 1e-4;
  Factors factors{VectorXd::Constant(shift.size(), kUniformPrecision), VectorXd::Zero(shift.size()), {}};
  update(precision, shift, factors);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0.0;
    for (Index k = 0; k < shift.size(); ++k) {
      moved = std::max(moved, refine(k, factors));
      update(precision, shift, factors);
    }
    if (moved < kTolerance) {
      break;
    }
  }
  return factors.moments;
}

}  // namespace twinmap::gp
