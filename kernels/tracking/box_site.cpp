#include "kernels/tracking/box_site.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace twinmap::tracking {
namespace {

constexpr double kFar = 8.0;     // standard deviations: beyond lies 1e-15 of a normal distribution
constexpr double kReach = 24.0;  // of an exponential distribution, which a bound makes of it, e^-25 is beyond
constexpr int kIntervals = 128;  // of Simpson's rule: a fifth of a standard deviation each

/// Moments 1 to 4 of the density exp(tilt u - curvature u^2 / 2) between two places.
std::array<double, 5> calcCutMoments(double tilt, double curvature, double lower, double upper) {
  const double step = (upper - lower) / kIntervals;
  const auto calcLog = [&](double u) { return u * (tilt - 0.5 * curvature * u); };
  const double largest = calcLog(std::min(std::max(tilt / curvature, lower), upper));
  std::array<double, 5> sums{};
  for (int i = 0; i <= kIntervals; ++i) {
    const double u = lower + i * step;
    double term = std::exp(calcLog(u) - largest) * (i == 0 || i == kIntervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
    for (double& sum : sums) {
      sum += term;
      term *= u;
    }
  }
  for (std::size_t k = 1; k < sums.size(); ++k) {
    sums[k] /= sums[0];
  }
  return sums;
}

}  // namespace

BoxSite calcBoxSite(Eigen::Index parameter, double mean, double variance) {
  constexpr int kMost = 20;
  constexpr double kTolerance = 1e-13, kLongest = 1.0, kLeast = 0.25;
  const double stddev = std::sqrt(variance);
  const double to_lower = (-1.0 - mean) / stddev, to_upper = (1.0 - mean) / stddev;
  if (!(to_lower < 0.0 && to_upper > 0.0) || (to_lower < -kFar && to_upper > kFar)) {
    return {parameter, 0.0, 0.0};
  }
  // of u = (x - mean) / stddev, whose mean is to be 0 and variance 1
  const double lower = std::max(to_lower, -kReach), upper = std::min(to_upper, kReach);
  double tilt = 0.0, curvature = 1.0;
  for (int i = 0; i < kMost; ++i) {
    const std::array<double, 5> m = calcCutMoments(tilt, curvature, lower, upper);
    const double by_tilt = m[2] - m[1] * m[1], by_both = m[3] - m[1] * m[2],
                 by_curvature = m[4] - m[2] * m[2];
    const double of_mean = -m[1], of_square = 1.0 - m[2];
    const double determinant = by_tilt * by_curvature - by_both * by_both;
    if (!(determinant > 0.0)) {  // by rounding
      break;
    }
    const double more_tilt = (of_mean * by_curvature - of_square * by_both) / determinant;
    const double more_curvature = -2.0 * (of_square * by_tilt - of_mean * by_both) / determinant;
    const double size = std::max(std::abs(more_tilt), std::abs(more_curvature));
    const double least = curvature * kLeast - curvature;  // so that it stays positive
    double share = size > kLongest ? kLongest / size : 1.0;
    share = share * more_curvature < least ? least / more_curvature : share;
    tilt += share * more_tilt;
    curvature += share * more_curvature;
    if (size < kTolerance) {
      break;
    }
  }
  const double precision = (1.0 - curvature) / variance;
  return {parameter, precision, precision * mean - tilt / stddev};
}

}  // namespace twinmap::tracking
