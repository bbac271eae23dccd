#include "framework/estimation/bounded_draws.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The weight of the draws between two values.
double calcMass(const BoundedDraws& draws, Index parameter, double one, double other) {
  const auto [from, to] = std::minmax(one, other);
  const auto values = draws.points.row(parameter).array();
  return ((values >= from && values <= to).cast<double>().transpose() * draws.weights.array()).sum();
}

/// Whether the density at a bound is at least that at a value, each by the draws within a tenth of the way
/// between them.
bool isDenseAtBound(const BoundedDraws& draws, Index parameter, double bound, double value) {
  constexpr double kShare = 0.1;
  const double width = kShare * (value - bound);
  const double at_bound = calcMass(draws, parameter, bound, bound + width);
  return at_bound > 0.0 && at_bound >= calcMass(draws, parameter, value - width, value);
}

}  // namespace

VectorXd BoundedDraws::calcQuantiles(Index parameter, const VectorXd& probabilities) const {
  return importance::calcQuantiles({points.row(parameter), weights}, probabilities).transpose();
}

std::pair<double, double> BoundedDraws::findInterval(Index parameter, double probability) const {
  const double outside = 1.0 - probability;
  const VectorXd quantiles =
      calcQuantiles(parameter, Eigen::Vector4d(0.5 * outside, 1.0 - 0.5 * outside, probability, outside));
  const bool at_lower = isDenseAtBound(*this, parameter, lower[parameter], quantiles[2]);
  const bool at_upper = isDenseAtBound(*this, parameter, upper[parameter], quantiles[3]);
  if (at_lower == at_upper) {  // neither, or as good as uniform
    return {quantiles[0], quantiles[1]};
  }
  return at_lower ? std::make_pair(lower[parameter], quantiles[2])
                  : std::make_pair(quantiles[3], upper[parameter]);
}

}  // namespace twinmap
