#include "framework/estimation/posterior/posterior_modes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Basin of each draw: the nearest in its own metric.
std::vector<std::size_t> assign(const MatrixXd& points, const std::vector<Basin>& basins) {
  std::vector<std::size_t> nearest(static_cast<std::size_t>(points.cols()), 0);
  VectorXd least = VectorXd::Constant(points.cols(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; basins.size() > 1 && k < basins.size(); ++k) {
    const MatrixXd lower = linalg::calcCholesky(basins[k].covariance).lower;
    const MatrixXd apart = linalg::solveLower(lower, points.colwise() - basins[k].local.at);
    for (Index i = 0; i < points.cols(); ++i) {
      if (const double distance = apart.col(i).squaredNorm(); distance < least[i]) {
        least[i] = distance;
        nearest[static_cast<std::size_t>(i)] = k;
      }
    }
  }
  return nearest;
}

/// The part of weighted draws that belongs to one group of basins.
importance::WeightedDraws takePart(const MatrixXd& points, const VectorXd& weights,
                                   const std::vector<std::size_t>& group_of_draw, std::size_t group) {
  VectorXd own = weights;
  for (Index i = 0; i < own.size(); ++i) {
    own[i] *= group_of_draw[static_cast<std::size_t>(i)] == group ? 1.0 : 0.0;
  }
  return {points, own};
}

/// Whether two parts of a distribution have a gap between them: seen along the line through their means,
/// these are more than twice the sum of the standard deviations apart. Two halves of a uniform distribution
/// are 1.7 times it apart, of a normal one 1.3 times.
bool areApart(const importance::WeightedDraws& a, const importance::WeightedDraws& b) {
  constexpr double kApart = 2.0;
  const auto normalize = [](const importance::WeightedDraws& part) {
    return importance::WeightedDraws{part.points, part.weights / part.weights.sum()};
  };
  const importance::WeightedDraws first = normalize(a), second = normalize(b);
  const VectorXd way = importance::calcMean(second) - importance::calcMean(first);
  const double length = way.norm();
  const auto spread = [&](const importance::WeightedDraws& part) {
    return std::sqrt(way.dot(importance::calcCovariance(part) * way)) / length;
  };
  return length > kApart * (spread(first) + spread(second));
}

/// The nearest basin of each draw, with those taken together that are one mode.
std::vector<std::size_t> groupDraws(const MatrixXd& points, const VectorXd& weights,
                                    const std::vector<Basin>& basins,
                                    const std::vector<std::pair<std::size_t, std::size_t>>& connected) {
  std::vector<std::size_t> group_of_draw = assign(points, basins);
  std::vector<std::size_t> group_of_basin(basins.size());
  std::iota(group_of_basin.begin(), group_of_basin.end(), std::size_t{0});
  for (const auto& [from, to] : connected) {
    const std::size_t kept = group_of_basin[from], other = group_of_basin[to];
    std::replace(group_of_basin.begin(), group_of_basin.end(), other, kept);
    std::replace(group_of_draw.begin(), group_of_draw.end(), other, kept);
  }
  for (std::size_t a = 0; a < basins.size(); ++a) {
    for (std::size_t b = a + 1; b < basins.size(); ++b) {
      const importance::WeightedDraws first = takePart(points, weights, group_of_draw, a),
                                      second = takePart(points, weights, group_of_draw, b);
      if (first.weights.sum() > 0.0 && second.weights.sum() > 0.0 && !areApart(first, second)) {
        std::replace(group_of_draw.begin(), group_of_draw.end(), b, a);
        b = a;  // the group has grown: it may touch others now
      }
    }
  }
  return group_of_draw;
}

/// The groups' parts of the draws.
std::vector<PosteriorMode> collectModes(const std::vector<Basin>& basins,
                                        const std::vector<std::size_t>& group_of_draw, const MatrixXd& draws,
                                        const VectorXd& weights) {
  std::vector<PosteriorMode> modes;
  for (std::size_t k = 0; k < basins.size(); ++k) {
    importance::WeightedDraws part = takePart(draws, weights, group_of_draw, k);
    const double weight = part.weights.sum();
    if (weight >= kRareLevel) {
      part.weights /= weight;
      const MatrixXd covariance = importance::calcCovariance(part);
      modes.push_back({weight, importance::calcMean(part), covariance.diagonal().cwiseSqrt(),
                       basins[k].local.chi_square, covariance});
    }
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const PosteriorMode& a, const PosteriorMode& b) { return a.weight > b.weight; });
  return modes;
}

}  // namespace

std::vector<PosteriorMode> findModes(const MatrixXd& points, const MatrixXd& draws, const VectorXd& weights,
                                     const std::vector<Basin>& basins,
                                     const std::vector<std::pair<std::size_t, std::size_t>>& connected) {
  return collectModes(basins, groupDraws(points, weights, basins, connected), draws, weights);
}

}  // namespace twinmap
