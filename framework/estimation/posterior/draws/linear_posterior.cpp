#include "framework/estimation/posterior/draws/linear_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "framework/base/random/random.hpp"
#include "framework/base/random/standard_normal.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/posterior/draws/draw_channels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/draw_rounds.hpp"
#include "kernels/sampling/elliptical_slice.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::AdaptiveDraws;

namespace {

/// Numbers of one chain, one after the other.
importance::SliceNumbers makeNumbers(const RandomStream& random) {
  auto used = std::make_shared<std::uint64_t>(0);
  return {[random, used] { return random.calcUniform((*used)++, kOfSlices); },
          [random, used](int count) {
            VectorXd normals(count);
            random.drawNormals((*used)++, kOfSlices, normals.data(), static_cast<std::size_t>(count));
            return normals;
          }};
}

/// The posterior with a likelihood that is normal about a basin's minimum, as the normal distribution of its
/// covariance times what the prior within the bounds is of its own normal approximation:
///   log f(at + s) = log prior(at + s) - s' d_prior + s' (H_prior + box) s / 2.
importance::TiltedNormal makeLinear(const MisfitSurface& surface, const Basin& basin) {
  const VectorXd& at = basin.local.at;
  const PriorMisfit prior = surface.linearizePrior(at);
  const MatrixXd information = addBounds(prior.information);
  return {at + basin.covariance * basin.local.descent, linalg::calcCholesky(basin.covariance).lower,
          [&surface, at, prior, information](const VectorXd& point) {
            if (!isInBox(point)) {
              return -std::numeric_limits<double>::infinity();
            }
            const VectorXd apart = point - at;
            return surface.calcLogPrior(point) - apart.dot(prior.descent) +
                   0.5 * apart.dot(information * apart);
          }};
}

/// Half of what a linear response adds to the loss at the basin's minimum, at points (u x n) about it.
VectorXd calcLinearLosses(const MisfitSurface& surface, const Basin& basin, const MatrixXd& points) {
  const PriorMisfit prior = surface.linearizePrior(basin.local.at);
  const MatrixXd information = basin.local.information - prior.information;
  const VectorXd descent = basin.local.descent - prior.descent;
  const MatrixXd apart = points.colwise() - basin.local.at;
  return 0.5 * apart.cwiseProduct(information * apart).colwise().sum().transpose() -
         apart.transpose() * descent;
}

/// One chain of draws of the linear posterior.
class LinearChain {
 public:
  LinearChain(const MisfitSurface& surface, const Basin& basin, std::uint64_t seed)
      : target_(makeLinear(surface, basin)),
        numbers_(makeNumbers(RandomStream(seed, RandomPurpose::kPosterior))),
        at_(basin.local.at) {}

  MatrixXd draw(int count) {
    constexpr int kSteps = 50;  // a draw: those of a uniform prior in a corner hardly depend on each other
    const MatrixXd points = importance::sampleEllipticalSlices(target_, at_, count, kSteps, numbers_);
    at_ = points.rightCols(1);
    return points;
  }

 private:
  const importance::TiltedNormal target_;
  const importance::SliceNumbers numbers_;
  VectorXd at_;
};

/// What draws of the linear posterior weigh by the simulator (log).
VectorXd calcLogWeights(MisfitSurface& surface, const Basin& basin, const MatrixXd& points) {
  VectorXd log_weights = surface.calcLogPosteriors(points) + calcLinearLosses(surface, basin, points);
  for (Index i = 0; i < points.cols(); ++i) {
    log_weights[i] -= surface.calcLogPrior(points.col(i));
  }
  return log_weights;
}

}  // namespace

AdaptiveDraws sampleLinearized(MisfitSurface& surface, const Basin& basin, int draws, int most_rounds,
                               std::uint64_t seed) {
  LinearChain chain(surface, basin, seed);
  const auto draw_round = [&](int) {
    const MatrixXd points = chain.draw(draws);
    return importance::Round{points, calcLogWeights(surface, basin, points)};
  };
  return importance::drawInRounds(draw_round, most_rounds);
}

AdaptiveDraws drawLinear(const MisfitSurface& surface, const Basin& basin, int draws, std::uint64_t seed) {
  const MatrixXd points = LinearChain(surface, basin, seed).draw(draws);
  return {importance::weigh(points, VectorXd::Zero(draws)), static_cast<double>(draws), 0.0, 1};
}

VectorXd calcDisplacements(MisfitSurface& surface, const Basin& basin, const MatrixXd& points) {
  const VectorXd& at = basin.local.at;
  const PriorMisfit prior = surface.linearizePrior(at);
  const VectorXd mean = clampToBox(at + basin.covariance * basin.local.descent);
  VectorXd squares = VectorXd::Zero(at.size());
  for (const LocalSurface& local : surface.linearize(points)) {
    if (!local.simulated) {
      return VectorXd::Constant(at.size(), std::numeric_limits<double>::infinity());
    }
    // with the prior of the minimum, and the box as a normal distribution about it
    const PriorMisfit own = surface.linearizePrior(local.at);
    const VectorXd apart = local.at - at;
    const VectorXd descent = local.descent - own.descent + prior.descent - prior.information * apart -
                             kHalfWidthInformation * apart;
    const MatrixXd covariance =
        BoundedInformation(local.information - own.information + prior.information).calcCovariance();
    squares += (clampToBox(local.at + covariance * descent) - mean).cwiseAbs2();
  }
  const VectorXd variances = static_cast<double>(points.cols()) * basin.covariance.diagonal();
  return squares.cwiseQuotient(variances).cwiseSqrt();
}

double calcNonlinearity(MisfitSurface& surface, const Basin& basin, std::uint64_t seed) {
  // The variance is then known to a fifth; of many parameters, whose simulations are dear, to 30 %.
  const int draws = surface.getDimensions() > kManyUnknown ? 24 : 48;
  const Eigen::ArrayXd logs =
      calcLogWeights(surface, basin, LinearChain(surface, basin, seed).draw(draws)).array();
  return logs.allFinite() ? (logs - logs.mean()).square().mean() : std::numeric_limits<double>::infinity();
}

bool areOneBasin(const MisfitSurface& surface, const std::vector<Basin>& basins) {
  const LocalSurface& first = basins.front().local;
  const MatrixXd information = first.information - surface.linearizePrior(first.at).information;
  return std::all_of(basins.begin() + 1, basins.end(), [&](const Basin& other) {
    const VectorXd apart = other.local.at - first.at;
    return apart.dot(information * apart) < kBasinAbove;
  });
}

BasinSearchOptions limitSearch(BasinSearchOptions options, Index drawn) {
  constexpr int kScouts = 3, kStarts = 8, kConfirmations = 2;
  if (drawn > kManyUnknown) {
    options.from_prior = true;
    options.scouts = std::min(options.scouts, kScouts);
    options.probes = std::min(options.probes, kScouts);
    options.starts = std::min(options.starts, kStarts);
    options.max_batches = std::min(options.max_batches, 1);
    options.confirmations = std::min(options.confirmations, kConfirmations);
  }
  return options;
}

MatrixXd addMedian(const MatrixXd& given, const Prior& prior, Index unknown, Index drawn) {
  if (drawn <= kManyUnknown || given.cols() > 0) {
    return given;
  }
  return prior.calcPoint(VectorXd::Constant(unknown, 0.5));
}

}  // namespace twinmap
