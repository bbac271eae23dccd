#include "framework/estimation/posterior/draws/linear_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "framework/base/random/random.hpp"
#include "framework/base/random/standard_normal.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/convergence.hpp"
#include "kernels/sampling/elliptical_slice.hpp"
#include "kernels/sampling/nuts.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::AdaptiveDraws;

namespace {

/// Numbers of one chain, one after the other; not those of the rounds of mixtures.
importance::SliceNumbers makeNumbers(const RandomStream& random) {
  constexpr std::uint64_t kChannel = 2, kReplicate = 1000;
  auto used = std::make_shared<std::uint64_t>(0);
  return {[random, used] { return random.calcUniform((*used)++, kChannel); },
          [random, used](int count) {
            VectorXd normals(count);
            random.drawNormals((*used)++, kReplicate, normals.data(), static_cast<std::size_t>(count));
            return normals;
          }};
}

/// The posterior with a likelihood that is normal about a basin's minimum, as the normal distribution of its
/// covariance times what the prior within the bounds is of its own normal approximation:
///   log f(at + s) = log prior(at + s) - s' d_prior + s' (H_prior + box) s / 2.
///   - curvature: what the bend adds to half the misfit; null: of a linear response.
importance::TiltedNormal makeLinear(const MisfitSurface& surface, const Basin& basin,
                                    const ResponseCurvature* curvature) {
  const VectorXd& at = basin.local.at;
  const PriorMisfit prior = surface.linearizePrior(at);
  MatrixXd information = prior.information;
  information.diagonal().array() += kHalfWidthInformation;
  return {at + basin.covariance * basin.local.descent, linalg::calcCholesky(basin.covariance).lower,
          [&surface, at, prior, information, curvature](const VectorXd& point) {
            if (!(point.cwiseAbs().maxCoeff() <= 1.0)) {
              return -std::numeric_limits<double>::infinity();
            }
            const VectorXd apart = point - at;
            return surface.calcLogPrior(point) - apart.dot(prior.descent) +
                   0.5 * apart.dot(information * apart) -
                   (curvature != nullptr ? curvature->calcBend(point) : 0.0);
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

/// Of a chain's draws (u x n), in the coordinate that it knows worst; at most 1.
double calcIndependentShare(const MatrixXd& points) {
  double least = 1.0;
  for (Index j = 0; j < points.rows(); ++j) {
    const markov::Convergence found = markov::calcConvergence({points.row(j).transpose()});
    least = std::min(least, found.effective_sample_size / static_cast<double>(points.cols()));
  }
  return least;
}

/// One chain of draws of the linear posterior, and what each weighs (log).
class LinearChain {
 public:
  LinearChain(MisfitSurface& surface, const Basin& basin, std::uint64_t seed,
              const ResponseCurvature* curvature = nullptr)
      : surface_(surface),
        basin_(basin),
        curvature_(curvature),
        random_(seed, RandomPurpose::kPosterior),
        numbers_(makeNumbers(random_)),
        at_(basin.local.at) {}

  void draw(int count) {
    const MatrixXd points = curvature_ == nullptr ? walk(count) : walkAlongBends(count);
    VectorXd log_weights = surface_.calcLogPosteriors(points) + calcLinearLosses(surface_, basin_, points);
    for (Index i = 0; i < count; ++i) {
      log_weights[i] -= surface_.calcLogPrior(points.col(i));
      log_weights[i] += curvature_ != nullptr ? curvature_->calcBend(points.col(i)) : 0.0;
    }
    const Index before = points_.cols();
    points_.conservativeResize(points.rows(), before + count);
    points_.rightCols(count) = points;
    log_weights_.conservativeResize(before + count);
    log_weights_.tail(count) = log_weights;
  }

  const VectorXd& getLogWeights() const { return log_weights_; }
  importance::WeightedDraws weigh() const { return importance::weigh(points_, log_weights_); }
  /// Of the draws, the share that depend on one another no more than independent ones would.
  double getIndependentShare() const { return independent_share_; }

 private:
  MatrixXd walk(int count) {
    constexpr int kSteps = 50;  // a draw: those of a uniform prior in a corner hardly depend on each other
    MatrixXd points = importance::sampleEllipticalSlices(makeLinear(surface_, basin_, nullptr), at_, count,
                                                         kSteps, numbers_);
    at_ = points.rightCols(1);
    return points;
  }

  /// Along a bent valley ellipses are short: by the gradient instead, in the basin's own axes.
  MatrixXd walkAlongBends(int count) {
    constexpr int kWarmUp = 300;
    const importance::TiltedNormal density = makeLinear(surface_, basin_, curvature_);
    const PriorMisfit prior = surface_.linearizePrior(basin_.local.at);
    const auto round = static_cast<std::uint64_t>(points_.cols());
    const auto draw = [&](std::uint64_t channel, Index i) {
      return random_.calcUniform(static_cast<std::uint64_t>(i), channel, round);
    };
    constexpr std::uint64_t kNormalChannel = 4, kUniformChannel = 5;
    markov::NutsOptions options;
    options.warm_up = kWarmUp;
    options.draws = count;
    const markov::Chain chain = markov::sampleNuts(
        [&](const VectorXd& z, VectorXd& gradient) { return calcWhitened(density, prior, z, gradient); },
        linalg::solveLower(density.lower, at_ - density.mean),
        {[&](Index i) { return toStandardNormal(draw(kNormalChannel, i)); },
         [&](Index i) { return draw(kUniformChannel, i); }},
        options);
    MatrixXd points = (density.lower * chain.draws).colwise() + density.mean;
    at_ = points.rightCols(1);
    independent_share_ = std::min(independent_share_, calcIndependentShare(points));
    return points;
  }

  /// log of a tilted normal density at mean + lower z, and its gradient by z. prior: at the basin's minimum.
  double calcWhitened(const importance::TiltedNormal& density, const PriorMisfit& prior, const VectorXd& z,
                      VectorXd& gradient) const {
    const VectorXd point = density.mean + density.lower * z;
    const double log_factor = density.log_factor(point);
    if (!std::isfinite(log_factor)) {
      return log_factor;
    }
    const VectorXd apart = point - basin_.local.at;
    const VectorXd slope = calcPriorSlope(point) - prior.descent - curvature_->calcBendSlope(point) +
                           prior.information * apart + kHalfWidthInformation * apart;
    gradient = density.lower.transpose() * slope - z;
    return log_factor - 0.5 * z.squaredNorm();
  }

  /// By central differences: no simulation is needed, and a prior is smooth.
  VectorXd calcPriorSlope(const VectorXd& point) const {
    constexpr double kStep = 1e-6;
    VectorXd slope(point.size()), moved = point;
    for (Index j = 0; j < point.size(); ++j) {
      moved[j] = point[j] + kStep;
      const double above = surface_.calcLogPrior(moved);
      moved[j] = point[j] - kStep;
      slope[j] = (above - surface_.calcLogPrior(moved)) / (2.0 * kStep);
      moved[j] = point[j];
    }
    return slope;
  }

  MisfitSurface& surface_;
  const Basin& basin_;
  const ResponseCurvature* curvature_;
  const RandomStream random_;
  const importance::SliceNumbers numbers_;
  double independent_share_ = 1.0;
  VectorXd at_, log_weights_;
  MatrixXd points_;
};

}  // namespace

AdaptiveDraws sampleLinearized(MisfitSurface& surface, const Basin& basin, int draws, int most_rounds,
                               std::uint64_t seed, const ResponseCurvature* curvature) {
  LinearChain chain(surface, basin, seed, curvature);
  AdaptiveDraws drawn;
  bool goes_on = true;
  while (goes_on) {
    chain.draw(draws);
    ++drawn.rounds;
    drawn.draws = chain.weigh();
    drawn.effective_sample_size =
        chain.getIndependentShare() * importance::calcEffectiveSampleSize(drawn.draws);
    const double reached = drawn.effective_sample_size / drawn.rounds * most_rounds;
    goes_on = drawn.rounds < most_rounds && drawn.effective_sample_size < importance::kSmallestSampleSize &&
              reached >= importance::kSmallestSampleSize;
  }
  drawn.pareto_shape = importance::calcParetoShape(drawn.draws);
  return drawn;
}

double calcNonlinearity(MisfitSurface& surface, const Basin& basin, std::uint64_t seed) {
  constexpr int kDraws = 48;  // the variance is then known to a fifth
  LinearChain chain(surface, basin, seed);
  chain.draw(kDraws);
  const Eigen::ArrayXd logs = chain.getLogWeights().array();
  return logs.allFinite() ? (logs - logs.mean()).square().mean() : std::numeric_limits<double>::infinity();
}

bool areOneBasin(const MisfitSurface& surface, const std::vector<Basin>& basins) {
  constexpr double kApart = 5.0;
  const LocalSurface& first = basins.front().local;
  const MatrixXd information = first.information - surface.linearizePrior(first.at).information;
  return std::all_of(basins.begin() + 1, basins.end(), [&](const Basin& other) {
    const VectorXd apart = other.local.at - first.at;
    return apart.dot(information * apart) < kApart * kApart;
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
