#include "framework/estimation/posterior/draws/posterior_draws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/base/random/scrambled_sobol.hpp"
#include "framework/base/random/standard_normal.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/first_proposal.hpp"
#include "framework/estimation/posterior/basins/straight_ridge.hpp"
#include "framework/estimation/posterior/draws/draw_channels.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/posterior/draws/local_walk.hpp"
#include "framework/estimation/posterior/draws/marginal_surface.hpp"
#include "framework/estimation/posterior/draws/randomized_minima.hpp"
#include "framework/estimation/posterior/draws/valley_places.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::AdaptiveDraws;
using importance::BoxMixture;
using importance::RoundNumbers;

namespace {

/// Effective draws a draw of a round: with 200, quantiles at 2.5 % are as good as means.
constexpr double kEnough = 0.4;

/// The numbers of the rounds, made when first asked for. All measurements have the same, so that their errors
/// are shared: they fill the cube evenly, which makes these errors small (a third to a tenth).
class Numbers {
 public:
  Numbers(Index dimensions, const PosteriorDrawOptions& options)
      : dimensions_(dimensions), draws_(options.draws), random_(options.seed, RandomPurpose::kPosterior) {}

  const RoundNumbers& get(int round) {
    while (static_cast<int>(rounds_.size()) <= round) {
      rounds_.push_back(make(static_cast<std::uint64_t>(rounds_.size())));
    }
    return rounds_[static_cast<std::size_t>(round)];
  }

 private:
  RoundNumbers make(std::uint64_t round) const {
    // a part of the proposal takes draws in a row, which are spread evenly among themselves too
    const double first = random_.calcUniform(0, kOfPicks, round);
    const auto pick = [&](Index i) { return (static_cast<double>(i) + first) / static_cast<double>(draws_); };
    return {VectorXd::NullaryExpr(draws_, pick),
            drawSobol(static_cast<int>(dimensions_), draws_, random_, kOfDraws, round)
                .unaryExpr(&toStandardNormal),
            drawSobol(1, importance::kCenters, random_, kOfCenters, round).transpose()};
  }

  const Index dimensions_, draws_;
  const RandomStream random_;
  std::vector<RoundNumbers> rounds_;
};

importance::AdaptiveOptions makeOptions() {
  importance::AdaptiveOptions options;
  options.max_rounds = kFewIterations;  // until the mixture follows a bent ridge
  options.enough = kEnough;
  return options;
}

/// The shares of the basins by Laplace's approximation, half of all spread evenly: it is wrong where a basin
/// is not a paraboloid.
VectorXd calcShares(const std::vector<Basin>& basins, const MisfitSurface& surface) {
  const auto count = static_cast<Index>(basins.size());
  VectorXd logs(count);
  for (Index k = 0; k < count; ++k) {
    const Basin& basin = basins[static_cast<std::size_t>(k)];
    const MatrixXd lower = linalg::calcCholesky(basin.covariance).lower;
    logs[k] =
        -0.5 * basin.local.loss + lower.diagonal().array().log().sum() + surface.calcLogPrior(basin.local.at);
  }
  const VectorXd weights = (logs.array() - logs.maxCoeff()).exp();
  return (0.5 * weights / weights.sum()).array() + 0.5 / static_cast<double>(count);
}

BoxMixture proposeFirst(const std::vector<Basin>& basins, const VectorXd& shares) {
  std::vector<importance::NormalPart> modes;
  for (std::size_t k = 0; k < basins.size(); ++k) {
    modes.push_back({shares[static_cast<Index>(k)], basins[k].local.at,
                     linalg::calcCholesky(basins[k].covariance).lower});
  }
  return proposeAround(modes);
}

/// Where the draws of the first round go: basins, by the shares of their masses.
BoxMixture propose(const MisfitSurface& surface, const Landscape& landscape, Index drawn) {
  std::vector<Basin> places = landscape.basins;
  const VectorXd shares = calcShares(places, surface);
  if (landscape.is_straight) {
    std::transform(places.begin(), places.end(), places.begin(), levelBasin);
  }
  return proposeFirst(projectBasins(std::move(places), drawn), shares);
}

/// A basin in the coordinates of sums.
Basin convertBasin(const Basin& basin, const SumCoordinates& sums) {
  Basin converted = basin;
  const MatrixXd slopes = sums.calcSlopes(basin.local.at);
  converted.local.at = sums.toSums(basin.local.at);
  converted.local.descent = slopes.transpose() * basin.local.descent;
  converted.local.information = slopes.transpose() * basin.local.information * slopes;
  converted.covariance = BoundedInformation(converted.local.information).calcCovariance();
  return converted;
}

/// By mixtures from basins.
AdaptiveDraws drawMixtures(MisfitSurface& surface, const Landscape& landscape, Index drawn,
                           const PosteriorDrawOptions& options) {
  Numbers numbers(drawn, options);
  std::optional<MarginalSurface> marginal;
  if (drawn < surface.getDimensions()) {
    marginal.emplace(surface, listIndices(drawn), landscape.basins);
  }
  return importance::sampleAdaptively(
      [&](const MatrixXd& points) {
        return marginal ? marginal->calcLogPosteriors(points) : surface.calcLogPosteriors(points);
      },
      propose(surface, landscape, drawn),
      [&](int round) -> const RoundNumbers& { return numbers.get(round); }, makeOptions());
}

/// Of many parameters about a bent response, where its bend is more than weights make good.
AdaptiveDraws drawAboutOne(MisfitSurface& surface, const Landscape& landscape, bool has_many,
                           const PosteriorDrawOptions& options) {
  const Basin& basin = landscape.basins.front();
  if (!has_many) {
    return sampleLinearized(surface, basin, options.draws, 1, options.seed);
  }
  const double nonlinearity =
      landscape.nonlinearity ? *landscape.nonlinearity : calcNonlinearity(surface, basin, options.seed);
  // the variance of log weights says how many of the draws count
  if (!(std::exp(-nonlinearity) > kEnough)) {
    if (const auto minima = RandomizedMinima::measure(surface, basin)) {
      return sampleRandomizedMinima(surface, *minima, options.draws, kFewIterations, options.seed);
    }
  }
  return sampleLinearized(surface, basin, options.draws, kFewIterations, options.seed);
}

/// Where chains begin: all over the valley, some at the basins' minima. From a minimum in a corner of the box
/// hardly a step leads anywhere, and draws of its surroundings look as good as those of all the valley.
MatrixXd listWalkStarts(MisfitSurface& surface, const std::vector<Basin>& basins, std::uint64_t seed) {
  constexpr Index kChains = 48, kOfBasins = 8;
  const std::vector<LocalSurface> places = findValleyPlaces(surface, basins, seed);
  const auto count = static_cast<Index>(places.size());
  const Index spread = count > 0 ? kChains - kOfBasins : 0;
  MatrixXd starts(surface.getDimensions(), kChains);
  for (Index k = 0; k < kChains; ++k) {
    starts.col(k) = k < spread ? places[static_cast<std::size_t>(k * count / spread % count)].at
                               : basins[static_cast<std::size_t>(k) % basins.size()].local.at;
  }
  return starts;
}

}  // namespace

/// The basins as they are seen in the first `drawn` coordinates alone.
std::vector<Basin> projectBasins(std::vector<Basin> basins, Index drawn) {
  for (Basin& basin : basins) {
    basin.local.at = VectorXd(basin.local.at.head(drawn));
    basin.covariance = MatrixXd(basin.covariance.topLeftCorner(drawn, drawn));
  }
  return basins;
}

AdaptiveDraws drawPosterior(MisfitSurface& surface, const Landscape& landscape, Index kept,
                            const PosteriorDrawOptions& options) {
  const bool has_many = kept > kManyUnknown;
  if (has_many || (surface.getDimensions() > kFewUnknown && areOneBasin(surface, landscape.basins))) {
    AdaptiveDraws drawn = drawAboutOne(surface, landscape, has_many, options);
    const bool is_good = drawn.isReliable() && drawn.effective_sample_size >= kEnough * options.draws &&
                         drawn.pareto_shape <= importance::AdaptiveOptions().good_pareto_shape;
    if (has_many || is_good) {
      drawn.draws.points = MatrixXd(drawn.draws.points.topRows(kept));
      return drawn;
    }
  }
  return drawMixtures(surface, landscape, kept, options);
}

AdaptiveDraws drawInSums(MisfitSurface& surface, const std::vector<Basin>& basins, const SumCoordinates& sums,
                         const PosteriorDrawOptions& options) {
  std::vector<Basin> straight;
  for (const Basin& basin : basins) {
    straight.push_back(levelBasin(convertBasin(basin, sums)));
  }
  const auto convert = [&](const MatrixXd& points) {
    return mapColumns(points, [&](const VectorXd& point) { return sums.fromSums(point); });
  };
  Numbers numbers(surface.getDimensions(), options);
  AdaptiveDraws drawn = importance::sampleAdaptively(
      [&](const MatrixXd& points) { return surface.calcLogPosteriors(convert(points)); },
      proposeFirst(straight, calcShares(basins, surface)),
      [&](int round) -> const RoundNumbers& { return numbers.get(round); }, makeOptions());
  drawn.draws.points = convert(drawn.draws.points);
  return drawn;
}

AdaptiveDraws drawAlongWalks(MisfitSurface& surface, const std::vector<Basin>& basins,
                             const PosteriorDrawOptions& options) {
  constexpr int kSteps[] = {48, 144};  // where the first draws are not to be believed, longer chains
  PosteriorDrawOptions more = options;
  more.draws *= 2;
  Numbers numbers(surface.getDimensions(), more);
  importance::AdaptiveOptions adaptive = makeOptions();
  adaptive.local = [&surface](const MatrixXd& points, const MatrixXd& lower) {
    return linearizeAt(surface, points, lower);
  };
  const MatrixXd starts = listWalkStarts(surface, basins, options.seed);
  AdaptiveDraws drawn;
  for (const int steps : kSteps) {
    const MatrixXd walked = walkPosterior(surface, starts, steps, options.seed);
    drawn = importance::sampleAdaptively(
        [&](const MatrixXd& points) { return surface.calcLogPosteriors(points); },
        importance::coverDraws(importance::weigh(walked, VectorXd::Zero(walked.cols())),
                               numbers.get(0).centers, adaptive.local),
        [&](int round) -> const RoundNumbers& { return numbers.get(round + 1); }, adaptive);
    if (drawn.isReliable()) {
      break;
    }
  }
  return drawn;
}

}  // namespace twinmap
