#include "framework/estimation/interval_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinmap {
namespace {

/// Whether a normal distribution's intervals of such a probability hold something else.
bool isMissed(const Eigen::VectorXd& depths, double probability, double factor, double samples) {
  const double held = (depths.array() < factor).cast<double>().mean();
  return std::abs(held - probability) > kNormal95 * calcProportionError(probability, samples);
}

}  // namespace

double IntervalFactor::calcEquivalentZ(double depth) const {
  if (depth < of50) {
    return kNormal50 * depth / of50;
  }
  if (depth > of95) {
    return kNormal95 * depth / of95;
  }
  return kNormal50 + (kNormal95 - kNormal50) * (depth - of50) / (of95 - of50);
}

IntervalFactors replicate(const IntervalFactors& factors, Eigen::Index estimates) {
  return {factors.of50.replicate(1, estimates), factors.of95.replicate(1, estimates)};
}

std::vector<IntervalFactor> takeFactors(const IntervalFactors& factors, Eigen::Index parameter) {
  std::vector<IntervalFactor> of_each;
  for (Eigen::Index i = 0; i < factors.of95.cols(); ++i) {
    of_each.push_back(factors.get(parameter, i));
  }
  return of_each;
}

double calcProportionError(double probability, double samples) {
  return std::sqrt(probability * (1.0 - probability) / samples);
}

double calcConformalQuantile(const Eigen::VectorXd& sorted, double probability) {
  const auto n = static_cast<double>(sorted.size());
  const double rank = std::ceil(probability * (n + 1.0));
  return sorted[static_cast<Eigen::Index>(std::clamp(rank, 1.0, n)) - 1];
}

IntervalFactor calcIntervalFactor(const Eigen::VectorXd& depths, double samples) {
  Eigen::VectorXd sorted = depths;
  std::sort(sorted.begin(), sorted.end());
  const double stretch = calcConformalQuantile(sorted, 0.68) / kNormal68;
  if (!isMissed(sorted, 0.5, stretch * kNormal50, samples) &&
      !isMissed(sorted, 0.95, stretch * kNormal95, samples)) {
    return {};
  }
  return {calcConformalQuantile(sorted, 0.5), calcConformalQuantile(sorted, 0.95)};
}

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
  double low = calcMiddleScale(sorted, 0.0), high = calcLargerScale(sorted, 0.0);
  while (high - low > std::numeric_limits<double>::epsilon() * high) {
    const double scale = 0.5 * (low + high);
    const double found =
        calcShareBelow(sorted, kNormal50 * scale) + 2.0 * calcShareBelow(sorted, kNormal95 * scale);
    (found < 0.5 + 2.0 * 0.95 ? low : high) = scale;
  }
  return high;
}

Eigen::VectorXd sortErrors(Eigen::VectorXd values) {
  std::sort(values.data(), values.data() + values.size());
  return values;
}

}  // namespace

double calcStddevScale(const Eigen::VectorXd& absolute_z) {
  const Eigen::VectorXd sorted = sortErrors(absolute_z);
  return sorted.size() > kManyErrors
             ? calcBalancedScale(sorted)
             : std::max(calcLargerScale(sorted, 0.0), std::min(1.0, calcLargerScale(sorted, kNormal95)));
}

Eigen::VectorXd calcTypicalStddev(const Eigen::MatrixXd& stddev) {
  return stddev.array().log().rowwise().mean().exp();
}

}  // namespace twinmap
