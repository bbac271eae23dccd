#include "framework/estimation/interval_factor.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {
namespace {

/// Whether a normal distribution's intervals of such a probability hold something else.
bool isMissed(const Eigen::VectorXd& depths, double probability, double factor, double samples) {
  constexpr double kErrors = 2.0;
  const double held = (depths.array() < factor).cast<double>().mean();
  return std::abs(held - probability) > kErrors * calcProportionError(probability, samples);
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

}  // namespace twinmap
