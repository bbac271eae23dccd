#include "kernels/sampling/weighted_draws.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernels/linalg/order.hpp"

namespace twinmap::importance {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Where each point lies between the least and the largest: half its weight above the weights before it.
struct SortedVariable {
  VectorXd values, positions;
};

SortedVariable sortVariable(const WeightedDraws& draws, Index variable) {
  const std::vector<Index> order = sortIndices(draws.weights.size(), [&](Index a, Index b) {
    return draws.points(variable, a) < draws.points(variable, b);
  });
  SortedVariable sorted{VectorXd(draws.weights.size()), VectorXd(draws.weights.size())};
  double before = 0.0;
  for (Index i = 0; i < sorted.values.size(); ++i) {
    const Index draw = order[static_cast<std::size_t>(i)];
    sorted.values[i] = draws.points(variable, draw);
    sorted.positions[i] = before + 0.5 * draws.weights[draw];
    before += draws.weights[draw];
  }
  return sorted;
}

double interpolate(const SortedVariable& sorted, double probability) {
  const double* begin = sorted.positions.data();
  const double* end = begin + sorted.positions.size();
  const Index above = std::lower_bound(begin, end, probability) - begin;
  if (above == 0 || above == sorted.positions.size()) {
    return sorted.values[std::min(above, sorted.values.size() - 1)];
  }
  const double apart = sorted.positions[above] - sorted.positions[above - 1];
  const double share = apart > 0.0 ? (probability - sorted.positions[above - 1]) / apart : 1.0;
  return sorted.values[above - 1] + share * (sorted.values[above] - sorted.values[above - 1]);
}

/// Excesses over the largest of the other weights, ascending; empty where they are too few.
ArrayXd listExcesses(const VectorXd& weights) {
  constexpr Index kMin = 5;
  constexpr double kShare = 0.2, kOfRoot = 3.0;
  std::vector<double> positive;
  std::copy_if(weights.begin(), weights.end(), std::back_inserter(positive), [](double w) { return w > 0; });
  const auto n = static_cast<double>(positive.size());
  const auto count = static_cast<Index>(std::min(kShare * n, kOfRoot * std::sqrt(n)));
  if (count < kMin) {
    return {};
  }
  std::sort(positive.begin(), positive.end());
  const Eigen::Map<const ArrayXd> sorted(positive.data(), static_cast<Index>(positive.size()));
  return sorted.tail(count) - sorted[sorted.size() - count - 1];
}

/// -1/m sum log(1 - b x): the shape that the likelihood prefers at scale shape / -b.
double calcShape(const ArrayXd& excesses, double b) {
  return (1.0 - b * excesses).log().mean();
}

/// The mean of b over its profile likelihood on the grid of Zhang and Stephens.
double averageProfile(const ArrayXd& excesses) {
  constexpr double kPrior = 3.0;
  const Index m = excesses.size();
  const auto count = static_cast<Index>(30.0 + std::sqrt(static_cast<double>(m)));
  const double quartile = excesses[static_cast<Index>(0.25 * static_cast<double>(m) + 0.5) - 1];
  ArrayXd grid(count), likelihood(count);
  for (Index j = 0; j < count; ++j) {
    const double root = std::sqrt(static_cast<double>(count) / (static_cast<double>(j) + 0.5));
    grid[j] = 1.0 / excesses[m - 1] + (1.0 - root) / (kPrior * quartile);
    const double shape = calcShape(excesses, grid[j]);
    likelihood[j] = static_cast<double>(m) * (std::log(-grid[j] / shape) - shape - 1.0);
  }
  const ArrayXd weights = (likelihood - likelihood.maxCoeff()).exp();
  return (grid * weights).sum() / weights.sum();
}

}  // namespace

WeightedDraws weigh(MatrixXd points, const VectorXd& log_weights) {
  constexpr double kNothing = -700.0;  // Eigen's exponential does not go below e^-716, which is not 0
  const ArrayXd relative = log_weights.array() - log_weights.maxCoeff();
  VectorXd weights = (relative < kNothing).select(0.0, relative.exp());
  weights /= weights.sum();
  return {std::move(points), std::move(weights)};
}

double calcEffectiveSampleSize(const WeightedDraws& draws) {
  return 1.0 / draws.weights.squaredNorm();
}

VectorXd calcMean(const WeightedDraws& draws) {
  return draws.points * draws.weights;
}

MatrixXd calcCovariance(const WeightedDraws& draws) {
  const MatrixXd centered = draws.points.colwise() - calcMean(draws);
  return centered * draws.weights.asDiagonal() * centered.transpose();
}

MatrixXd calcQuantiles(const WeightedDraws& draws, const VectorXd& probabilities) {
  MatrixXd quantiles(draws.points.rows(), probabilities.size());
  for (Index variable = 0; variable < quantiles.rows(); ++variable) {
    const SortedVariable sorted = sortVariable(draws, variable);
    for (Index k = 0; k < probabilities.size(); ++k) {
      quantiles(variable, k) = interpolate(sorted, probabilities[k]);
    }
  }
  return quantiles;
}

MatrixXd resample(const WeightedDraws& draws, const VectorXd& uniforms) {
  VectorXd ends(draws.weights.size());
  std::partial_sum(draws.weights.begin(), draws.weights.end(), ends.begin());
  ends /= ends[ends.size() - 1];
  MatrixXd chosen(draws.points.rows(), uniforms.size());
  for (Index i = 0; i < uniforms.size(); ++i) {
    const double* end = std::upper_bound(ends.data(), ends.data() + ends.size(), uniforms[i]);
    chosen.col(i) = draws.points.col(std::min<Index>(end - ends.data(), ends.size() - 1));
  }
  return chosen;
}

WeightedDraws temper(const MatrixXd& points, const VectorXd& log_weights, double least) {
  constexpr int kBisections = 40;
  constexpr double kLeastPower = 1e-12;
  const auto raise = [&](double log_power) {
    return weigh(points, std::exp(log_power) * (log_weights.array() - log_weights.maxCoeff()));
  };
  WeightedDraws draws = raise(0.0);
  if (calcEffectiveSampleSize(draws) >= least) {
    return draws;
  }
  double below = std::log(kLeastPower), above = 0.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (below + above);
    (calcEffectiveSampleSize(raise(middle)) < least ? above : below) = middle;
  }
  return raise(below);
}

double calcParetoShape(const WeightedDraws& draws) {
  constexpr double kPriorWeights = 10.0, kPriorShape = 0.5;
  constexpr double kBounded = 0.0;
  const ArrayXd excesses = listExcesses(draws.weights);
  if (excesses.size() == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto m = static_cast<double>(excesses.size());
  const Index quarter = static_cast<Index>(0.25 * m + 0.5) - 1;
  if (!(excesses[quarter] > std::numeric_limits<double>::min())) {
    return kBounded;  // weights that are equal have no tail
  }
  const double shape = calcShape(excesses, averageProfile(excesses));
  return (m * shape + kPriorWeights * kPriorShape) / (m + kPriorWeights);
}

}  // namespace twinmap::importance
