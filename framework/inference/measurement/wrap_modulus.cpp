#include "framework/inference/measurement/wrap_modulus.hpp"

#include <cmath>
#include <vector>

#include "framework/data/measurement/time_series.hpp"
#include "framework/estimation/levels.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// What jumps by nearly the range is more than the steps about it; 0 where no sample does.
double findBySize(const VectorXd& values) {
  const std::vector<Index> jumps = findTurnJumps(values, values.maxCoeff() - values.minCoeff());
  std::vector<double> moduli;
  for (const Index i : jumps) {
    if (i > 1 && i + 1 < values.size()) {
      const double step = 0.5 * (values[i - 1] - values[i - 2] + values[i + 1] - values[i]);
      moduli.push_back(std::abs(values[i] - values[i - 1] - step));
    }
  }
  return calcMedian(std::move(moduli));
}

VectorXd calcSecondDifferences(const VectorXd& values) {
  const Index n = values.size() - 2;
  return values.tail(n) - 2.0 * values.segment(1, n) + values.head(n);
}

VectorXd calcFourthDifferences(const VectorXd& values) {
  return calcSecondDifferences(calcSecondDifferences(values));
}

/// Least squares of the fourth differences over the modulus, for the turns that the last one makes. They
/// begin with the range, a little less than the modulus.
double findBySmoothness(const VectorXd& times, const VectorXd& values) {
  constexpr double kHalf = 0.5, kFarthest = 2.0;
  // of what jumps at random, over the modulus: second differences are within half of it, evenly, and theirs
  // follow
  const double by_chance = std::sqrt(6.0 / 12.0);
  const double range = values.maxCoeff() - values.minCoeff();
  const VectorXd measured = calcFourthDifferences(values);
  double modulus = range;
  VectorXd continued = measured;
  for (int i = 0; i < kFewIterations; ++i) {
    const VectorXd turns = ((unwrap(times, values, modulus) - values) / modulus).array().round();
    const VectorXd bends = calcFourthDifferences(turns);
    modulus = -bends.dot(measured) / bends.squaredNorm();
    continued = measured + modulus * bends;
    if (!(modulus < kFarthest * range && kFarthest * modulus > range)) {  // nor where nothing turns
      return 0.0;
    }
  }
  const double rest = std::sqrt(continued.squaredNorm() / static_cast<double>(continued.size()));
  return rest < kHalf * by_chance * modulus ? modulus : 0.0;
}

}  // namespace

double findModulus(const VectorXd& times, const VectorXd& values) {
  if (values.size() < 2 * kPerUnknown || !values.allFinite() || values.minCoeff() == values.maxCoeff()) {
    return 0.0;
  }
  const double by_size = findBySize(values);
  return by_size > 0.0 ? by_size : findBySmoothness(times, values);
}

}  // namespace twinmap
