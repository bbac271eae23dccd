#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "framework/estimation/surrogate/posterior/score_likelihood.hpp"
#include "framework/estimation/surrogate/score_inversion.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

/// What posteriors are computed from: a surrogate, whoever trained it, and its box.
struct PosteriorModel {
  std::shared_ptr<const ForwardSurrogate> forward;
  Eigen::VectorXd center, half_width;  ///< m, of the sampled box
  Eigen::Index parameters = 0;         ///< p: the first variables of a point, which are reported
  BoxPrior prior;                      ///< of the u unknown: with the nuisance parameters
  /// p, at least 1: by which a cross-validation found the likelihood too narrow about its maximum.
  Eigen::VectorXd stddev_scale;
  /// The prior itself, by which draws weigh; null where it is uniform.
  std::shared_ptr<const Prior> density{};
};

/// That of a surrogate. Where its cross-validation makes standard deviations smaller, the likelihood stays as
/// it is: what was too wide is the normal distribution that a map answers with.
PosteriorModel makePosteriorModel(const Surrogate& surrogate, std::shared_ptr<const Prior> density);

/// The posterior of the parameters given one measurement, without a normal approximation; p parameters in
/// their units. Only the diagnostics are there where it is not reliable.
struct SurrogatePosterior {
  Eigen::VectorXd mean, stddev;        ///< p
  Eigen::MatrixXd covariance;          ///< p x p
  importance::WeightedDraws weighted;  ///< u x n, all that were drawn
  Eigen::MatrixXd draws;               ///< u x n, of equal weight: resampled
  Eigen::VectorXd normal_mean;         ///< p: what ScoreInversion answers
  Eigen::MatrixXd normal_covariance;   ///< p x p
  double effective_sample_size = 0.0;  ///< importance::calcEffectiveSampleSize()
  double pareto_shape = 0.0;           ///< importance::calcParetoShape()
  int evaluations = 0;                 ///< draws of all rounds
  std::string message;                 ///< why it is not reliable; else empty

  bool isReliable() const { return message.empty(); }
};

/// Importance sampling under the prior within the box and the ScoreLikelihood, stretched about the nearest
/// mode by PosteriorModel::stddev_scale. The proposal is what ScoreInversion finds, each mode as a normal
/// distribution and one of twice its width, and the box, so that weights are bounded. Where the effective
/// sample size is below a fifth of the draws or the Pareto shape above 0.5, rounds of as many more follow, of
/// a mixture that covers those there are (importance::coverDraws), at most four; all draws count, weighted by
/// the mixture of all proposals (Cornuet, Marin, Mira and Robert 2012). Reliable: an effective sample size of
/// at least 100, and a Pareto shape of at most 0.7.
///
/// One object a thread: it holds the buffers.
class PosteriorSampler {
 public:
  /// draws: of each round, at least kMinPosteriorDraws. Random numbers depend on `seed`, the round and the
  /// number of the draw.
  PosteriorSampler(PosteriorModel model, int draws, std::uint64_t seed);

  /// scores (r), normalised known variables (m - u). `sample` keys the random numbers too: the same
  /// measurement gives the same answer, whatever came before. Cost: that of ScoreInversion::infer() and of
  /// ScoreLikelihood for each draw.
  SurrogatePosterior sample(const Eigen::Ref<const Eigen::VectorXd>& scores,
                            const Eigen::Ref<const Eigen::VectorXd>& known, std::uint64_t sample = 0);

  /// The same for features (d) and known inputs (m - u), in their units.
  SurrogatePosterior sampleFeatures(const Eigen::Ref<const Eigen::VectorXd>& features,
                                    const Eigen::Ref<const Eigen::VectorXd>& known, std::uint64_t sample = 0);

 private:
  const importance::RoundNumbers& getNumbers(int round, std::uint64_t sample);
  importance::BoxMixture proposeFirst() const;
  Eigen::VectorXd calcLogs(const Eigen::MatrixXd& points);
  Eigen::VectorXd stretch(const Eigen::VectorXd& point) const;
  Eigen::MatrixXd stretchAll(const Eigen::MatrixXd& points) const;
  SurrogatePosterior summarize(const importance::AdaptiveDraws& drawn, const gp::Moments& normal,
                               std::uint64_t sample) const;
  Eigen::VectorXd drawUniforms(Eigen::Index count, int channel, std::uint64_t sample) const;

  const PosteriorModel model_;
  const int draws_;
  const std::uint64_t seed_;
  ScoreInversion inversion_;
  ScoreLikelihood likelihood_;
  std::vector<Eigen::MatrixXd> mode_factors_;      // of the modes' covariances
  std::vector<importance::RoundNumbers> numbers_;  // of each round, of numbers_sample_
  std::uint64_t numbers_sample_ = 0;
};

/// Fewer draws leave too few large weights to tell their tail by.
constexpr int kMinPosteriorDraws = 200;
/// The error of a mean is then below a tenth of a standard deviation, that of a 95 % bound a quarter.
constexpr int kDefaultPosteriorDraws = 512;

}  // namespace twinmap
