#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "kernels/sampling/box_mixture.hpp"

namespace twinmap::importance {

/// Log densities (n), but for a summand, at points (u x n): -infinity where the density is 0.
using LogDensities = std::function<Eigen::VectorXd(const Eigen::MatrixXd& points)>;

/// Parts about single draws of a proposal that covers others.
constexpr int kCenters = 24;

/// The random numbers of a round.
struct RoundNumbers {
  Eigen::VectorXd picks;    ///< n, in (0, 1): the part of the proposal that each draw is of
  Eigen::MatrixXd normals;  ///< u x n, standard normal
  Eigen::VectorXd centers;  ///< in (0, 1): which draws the next proposal puts parts about
};
using RoundSource = std::function<const RoundNumbers&(int round)>;

struct AdaptiveOptions {
  int max_rounds = 4;
  /// Of a round's draws: with an effective sample size below it another round follows.
  double enough = 0.2;
  /// Likewise with a Pareto shape above it, where the weights have no variance.
  double good_pareto_shape = 0.5;
  LocalNormals local;  ///< of the parts about single draws; else the draws nearby say how wide these are
};

/// Draws of a density, weighted.
struct AdaptiveDraws {
  WeightedDraws draws;
  double effective_sample_size = 0.0;  ///< calcEffectiveSampleSize(); NaN where all draws were impossible
  double pareto_shape = 0.0;           ///< calcParetoShape()
  int rounds = 0;

  /// Whether moments and quantiles are to be believed: an effective sample size of kSmallestSampleSize and a
  /// Pareto shape of 0.7, above which errors no longer fall with the number of draws.
  bool isReliable() const { return findObstacle().empty(); }
  std::string findObstacle() const;  ///< why they are not; empty if they are
};

/// Adaptive multiple importance sampling (Cornuet, Marin, Mira and Robert 2012) of a density on [-1, 1]^u:
/// draws of `first`; while too few of them bear the weight, rounds of as many more, of a mixture that covers
/// those there are (coverDraws). All draws count, weighted by the mixture of all proposals. Cost: the density
/// at each draw and, a round, that of coverDraws().
AdaptiveDraws sampleAdaptively(const LogDensities& density, const BoxMixture& first,
                               const RoundSource& numbers, const AdaptiveOptions& options = {});

}  // namespace twinmap::importance
