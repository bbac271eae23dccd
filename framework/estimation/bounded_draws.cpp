#include "framework/estimation/bounded_draws.hpp"

#include <algorithm>
#include <vector>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Draws of one parameter.
struct Marginal {
  VectorXd values;
  const VectorXd& weights;
  double lower, upper;  // bounds
};

VectorXd calcMarginalQuantiles(const Marginal& marginal, const VectorXd& probabilities) {
  return importance::calcQuantiles({marginal.values.transpose(), marginal.weights}, probabilities)
      .transpose();
}

/// The weight of the draws between two values.
double calcMass(const Marginal& marginal, double one, double other) {
  const auto [from, to] = std::minmax(one, other);
  const auto values = marginal.values.array();
  return ((values >= from && values <= to).cast<double>() * marginal.weights.array()).sum();
}

/// Whether the density at a bound is at least that at a value, each by the draws within a tenth of the way
/// between them.
bool isDenseAtBound(const Marginal& marginal, double bound, double value) {
  constexpr double kShare = 0.1;
  const double width = kShare * (value - bound);
  const double at_bound = calcMass(marginal, bound, bound + width);
  return at_bound > 0.0 && at_bound >= calcMass(marginal, value - width, value);
}

/// With as much on either side, or from the one bound that is dense.
std::pair<double, double> findMarginalInterval(const Marginal& marginal, double probability) {
  const double outside = 1.0 - probability;
  const VectorXd quantiles = calcMarginalQuantiles(
      marginal, Eigen::Vector4d(0.5 * outside, 1.0 - 0.5 * outside, probability, outside));
  const bool at_lower = isDenseAtBound(marginal, marginal.lower, quantiles[2]);
  const bool at_upper = isDenseAtBound(marginal, marginal.upper, quantiles[3]);
  if (at_lower == at_upper) {  // neither, or as good as uniform
    return {quantiles[0], quantiles[1]};
  }
  return at_lower ? std::make_pair(marginal.lower, quantiles[2])
                  : std::make_pair(quantiles[3], marginal.upper);
}

Marginal takeMarginal(const BoundedDraws& draws, Index parameter) {
  return {draws.points.row(parameter).transpose(), draws.weights, draws.lower[parameter],
          draws.upper[parameter]};
}

/// The other parameters that may well be 0, as their 95 % intervals end at a bound of 0.
std::vector<Index> listPossiblyAbsent(const BoundedDraws& draws, Index parameter) {
  constexpr double kProbability = 0.95;
  std::vector<Index> absent;
  for (Index j = 0; j < draws.points.rows(); ++j) {
    if (j != parameter && (draws.lower[j] == 0.0 || draws.upper[j] == 0.0)) {
      const auto [from, to] = findMarginalInterval(takeMarginal(draws, j), kProbability);
      if ((draws.lower[j] == 0.0 && from == 0.0) || (draws.upper[j] == 0.0 && to == 0.0)) {
        absent.push_back(j);
      }
    }
  }
  return absent;
}

/// What a parameter's draws change by where parameters (columns of the result) are 0: what a linear
/// regression on these explains. Exact where the posterior is a normal distribution that bounds cut.
MatrixXd calcChangesWithout(const BoundedDraws& draws, Index parameter, const std::vector<Index>& absent) {
  const MatrixXd others = draws.points(absent, Eigen::all);
  const MatrixXd centered = others.colwise() - VectorXd(others * draws.weights);
  const MatrixXd weighted = centered * draws.weights.asDiagonal();
  const VectorXd slopes = linalg::solveMinimumNorm(weighted * centered.transpose(),
                                                   weighted * draws.points.row(parameter).transpose());
  return -(slopes.asDiagonal() * others).transpose();
}

}  // namespace

VectorXd BoundedDraws::calcQuantiles(Index parameter, const VectorXd& probabilities) const {
  return calcMarginalQuantiles(takeMarginal(*this, parameter), probabilities);
}

std::pair<double, double> BoundedDraws::findInterval(Index parameter, double probability) const {
  const Marginal marginal = takeMarginal(*this, parameter);
  std::pair<double, double> interval = findMarginalInterval(marginal, probability);
  const std::vector<Index> absent = listPossiblyAbsent(*this, parameter);
  if (absent.empty()) {
    return interval;
  }
  const MatrixXd changes = calcChangesWithout(*this, parameter, absent);
  const VectorXd means = changes.transpose() * weights;
  for (const double side : {-1.0, 1.0}) {  // those whose absence lowers the parameter, and that raise it
    Marginal without = marginal;
    for (Index j = 0; j < means.size(); ++j) {
      without.values += side * means[j] > 0.0 ? VectorXd(changes.col(j)) : VectorXd::Zero(weights.size());
    }
    without.values = without.values.cwiseMax(marginal.lower).cwiseMin(marginal.upper);
    const auto [from, to] = findMarginalInterval(without, probability);
    interval = {std::min(interval.first, from), std::max(interval.second, to)};
  }
  return interval;
}

}  // namespace twinmap
