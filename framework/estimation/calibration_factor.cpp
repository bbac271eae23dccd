#include "framework/estimation/calibration_factor.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/interval_factor.hpp"

namespace twinmap {
namespace {

/// A quantile over that of the normal distribution; of its confidence limit so many standard errors of the
/// rank above it.
double calcQuantileScale(const Eigen::VectorXd& sorted, double level, double normal, double errors_above) {
  const double error = calcProportionError(level, static_cast<double>(sorted.size()));
  return calcConformalQuantile(sorted, level + errors_above * error) / normal;
}

double calcMiddleScale(const Eigen::VectorXd& sorted, double errors_above) {
  return calcQuantileScale(sorted, 0.68, kNormal68, errors_above);
}

/// The larger of those of the middle and of the tail.
double calcLargerScale(const Eigen::VectorXd& sorted, double errors_above) {
  return std::max(calcMiddleScale(sorted, errors_above),
                  calcQuantileScale(sorted, 0.95, kNormal95, errors_above));
}

/// The share of the errors that are below a value.
double calcShareBelow(const Eigen::VectorXd& sorted, double value) {
  return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin()) /
         static_cast<double>(sorted.size());
}

/// The factor between the middle's and the larger one by which coverage of 50 % and 95 % intervals misses
/// these by opposite amounts, those of 95 % counted twice. Their sum rises with the factor, so that halving
/// finds it.
double calcBalancedScale(const Eigen::VectorXd& sorted) {
  constexpr int kHalvings = 40;
  constexpr double kWanted = 0.5 + 2.0 * 0.95;
  double low = calcMiddleScale(sorted, 0.0), high = calcLargerScale(sorted, 0.0);
  for (int i = 0; i < kHalvings; ++i) {
    const double scale = 0.5 * (low + high);
    const double found =
        calcShareBelow(sorted, kNormal50 * scale) + 2.0 * calcShareBelow(sorted, kNormal95 * scale);
    (found < kWanted ? low : high) = scale;
  }
  return high;
}

Eigen::VectorXd sortErrors(Eigen::VectorXd values) {
  std::sort(values.data(), values.data() + values.size());
  return values;
}

}  // namespace

double calcStddevScale(const Eigen::VectorXd& absolute_z) {
  constexpr Eigen::Index kMany = 2000;  // whose factor has a standard error of 2 %
  const Eigen::VectorXd sorted = sortErrors(absolute_z);
  return sorted.size() > kMany
             ? calcBalancedScale(sorted)
             : std::max(calcLargerScale(sorted, 0.0), std::min(1.0, calcLargerScale(sorted, kNormal95)));
}

Eigen::VectorXd calcTypicalStddev(const Eigen::MatrixXd& stddev) {
  return stddev.array().log().rowwise().mean().exp();
}

}  // namespace twinmap
