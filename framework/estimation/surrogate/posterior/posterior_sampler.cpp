#include "framework/estimation/surrogate/posterior/posterior_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/random/random.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/first_proposal.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::BoxMixture;
using importance::WeightedDraws;

PosteriorModel makePosteriorModel(const Surrogate& surrogate, std::shared_ptr<const Prior> density) {
  return {surrogate.forward,    surrogate.center, surrogate.half_width,
          surrogate.parameters, surrogate.prior,  surrogate.validation.stddev_scale.cwiseMax(1.0),
          std::move(density)};
}

PosteriorSampler::PosteriorSampler(PosteriorModel model, int draws, std::uint64_t seed)
    : model_(std::move(model)),
      draws_(draws),
      seed_(seed),
      inversion_(*model_.forward, model_.prior),
      likelihood_(*model_.forward) {}

SurrogatePosterior PosteriorSampler::sampleFeatures(const Eigen::Ref<const VectorXd>& features,
                                                    const Eigen::Ref<const VectorXd>& known,
                                                    std::uint64_t sample) {
  const Index q = known.size();
  const VectorXd normalised =
      q > 0 ? VectorXd((known - model_.center.tail(q)).cwiseQuotient(model_.half_width.tail(q))) : VectorXd();
  return this->sample(model_.forward->calcScores(features), normalised, sample);
}

SurrogatePosterior PosteriorSampler::sample(const Eigen::Ref<const VectorXd>& scores,
                                            const Eigen::Ref<const VectorXd>& known, std::uint64_t sample) {
  const gp::Moments normal = inversion_.infer(scores, known);
  likelihood_.setMeasurement(scores, known, inversion_.getModes().front().widening);
  mode_factors_.clear();
  for (const ScoreMode& mode : inversion_.getModes()) {
    mode_factors_.push_back(linalg::calcCholesky(mode.moments.covariance).lower);
  }
  const importance::AdaptiveDraws drawn = importance::sampleAdaptively(
      [&](const MatrixXd& points) { return calcLogs(points); }, proposeFirst(),
      [&](int round) -> const importance::RoundNumbers& { return getNumbers(round, sample); });
  return summarize(drawn, normal, sample);
}

const importance::RoundNumbers& PosteriorSampler::getNumbers(int round, std::uint64_t sample) {
  if (sample != numbers_sample_) {
    numbers_.clear();
    numbers_sample_ = sample;
  }
  const RandomStream random(seed_, RandomPurpose::kSurrogatePosterior);
  while (static_cast<int>(numbers_.size()) <= round) {
    const auto first = static_cast<std::uint64_t>(draws_) * numbers_.size();
    const auto draw = [&](Index i) { return first + static_cast<std::uint64_t>(i); };
    const auto calc_pick = [&](Index i) { return random.calcUniform(draw(i), 0, sample); };
    const auto calc_normal = [&](Index k, Index i) {
      return random.calcNormal(draw(i), static_cast<std::uint64_t>(k) + 1, sample);
    };
    numbers_.push_back({VectorXd::NullaryExpr(draws_, calc_pick),
                        MatrixXd::NullaryExpr(model_.prior.count(), draws_, calc_normal),
                        drawUniforms(importance::kCenters, static_cast<int>(numbers_.size()) + 1, sample)});
  }
  return numbers_[static_cast<std::size_t>(round)];
}

/// Of a round, counted from 1; in channel 0 those that draws are resampled by.
VectorXd PosteriorSampler::drawUniforms(Index count, int channel, std::uint64_t sample) const {
  const RandomStream random(seed_, RandomPurpose::kPosteriorResampling);
  return VectorXd::NullaryExpr(count, [&](Index i) {
    return random.calcUniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(channel), sample);
  });
}

/// Of likelihood, where it is calibrated, and prior.
VectorXd PosteriorSampler::calcLogs(const MatrixXd& points) {
  VectorXd logs = likelihood_.calcLogs(stretchAll(points));
  if (model_.density != nullptr) {
    const auto center = model_.center.head(model_.prior.count()),
               half_width = model_.half_width.head(model_.prior.count());
    for (Index i = 0; i < points.cols(); ++i) {
      if (std::isfinite(logs[i])) {
        logs[i] += model_.density->calcLogDensity(center + half_width.cwiseProduct(points.col(i)));
      }
    }
  }
  return logs;
}

BoxMixture PosteriorSampler::proposeFirst() const {
  std::vector<importance::NormalPart> modes;
  for (std::size_t k = 0; k < mode_factors_.size(); ++k) {
    const ScoreMode& mode = inversion_.getModes()[k];
    VectorXd scale = VectorXd::Ones(model_.prior.count());
    scale.head(model_.parameters) = model_.stddev_scale;
    modes.push_back({mode.share, mode.moments.mean, scale.asDiagonal() * mode_factors_[k]});
  }
  return proposeAround(modes);
}

/// Where the likelihood is taken for a point: nearer to the nearest mode, by the calibrated scale. It is in
/// the box if the point is.
VectorXd PosteriorSampler::stretch(const VectorXd& point) const {
  const std::vector<ScoreMode>& modes = inversion_.getModes();
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < modes.size() && modes.size() > 1; ++k) {
    const VectorXd apart = linalg::solveLower(mode_factors_[k], point - modes[k].moments.mean);
    if (const double distance = apart.squaredNorm(); distance < least) {
      least = distance;
      nearest = k;
    }
  }
  const Index p = model_.parameters;
  const VectorXd mode = clampToBox(modes[nearest].moments.mean).head(p);
  VectorXd stretched = point;
  stretched.head(p) = mode + (point.head(p) - mode).cwiseQuotient(model_.stddev_scale);
  return stretched;
}

MatrixXd PosteriorSampler::stretchAll(const MatrixXd& points) const {
  MatrixXd stretched = points;  // what is outside the box remains there
  for (Index i = 0; i < points.cols(); ++i) {
    if (isInBox(points.col(i))) {
      stretched.col(i) = stretch(points.col(i));
    }
  }
  return stretched;
}

SurrogatePosterior PosteriorSampler::summarize(const importance::AdaptiveDraws& drawn,
                                               const gp::Moments& normal, std::uint64_t sample) const {
  const Index p = model_.parameters, u = model_.prior.count();
  const WeightedDraws& draws = drawn.draws;
  SurrogatePosterior posterior;
  posterior.evaluations = static_cast<int>(draws.points.cols());
  posterior.effective_sample_size = drawn.effective_sample_size;
  posterior.pareto_shape = drawn.pareto_shape;
  posterior.message = drawn.findObstacle();
  if (!posterior.isReliable()) {
    return posterior;
  }
  const VectorXd center = model_.center.head(u), half_width = model_.half_width.head(u);
  const auto scale = [&](const MatrixXd& covariance) -> MatrixXd {
    return (half_width.asDiagonal() * covariance * half_width.asDiagonal()).topLeftCorner(p, p);
  };
  posterior.mean = (center + half_width.cwiseProduct(importance::calcMean(draws))).head(p);
  posterior.covariance = scale(importance::calcCovariance(draws));
  posterior.stddev = posterior.covariance.diagonal().cwiseSqrt();
  posterior.weighted = {(half_width.asDiagonal() * draws.points).colwise() + center, draws.weights};
  posterior.normal_mean = (center + half_width.cwiseProduct(normal.mean)).head(p);
  posterior.normal_covariance = scale(normal.covariance);
  const MatrixXd chosen = importance::resample(draws, drawUniforms(draws_, 0, sample));
  posterior.draws = (half_width.asDiagonal() * chosen).colwise() + center;
  return posterior;
}

}  // namespace twinmap
