#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/estimation/box_prior.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/surrogate/forward_surrogate.hpp"
#include "kernels/surrogate/box_moments.hpp"

namespace twinmap {

/// How calibrated a surrogate's own standard deviations are.
enum class SurrogateStatus {
  kOk,
  kEstimatorLimited  ///< they had to be corrected much: more simulations, or another map, would do better
};

/// "ok", "estimator_limited".
const char* toString(SurrogateStatus status);

/// What the cross-validation of a surrogate found: simulations that it had not seen, with fresh noise.
struct SurrogateValidation {
  Eigen::VectorXd stddev_scale;          ///< p, by which standard deviations were multiplied
  Eigen::VectorXd coverage95;            ///< p, of the 95 % intervals before that
  Eigen::MatrixXd residual_correlation;  ///< p x p, of the errors of a sample
  double log_density = 0.0;     ///< mean log joint density of the true parameters after that, in their units
  Eigen::VectorXd limit_scale;  ///< p: calcLimitScale()
  Eigen::VectorXd limit_ratio;  ///< p, root of the mean variance over that of the limit, both as predicted
  SurrogateStatus status = SurrogateStatus::kOk;
  IntervalFactors interval_factors{};  ///< of a network whose errors are not normal

  /// Parameters whose standard deviations had to be multiplied by more than 1.2: of twelve mechanisms
  /// posteriors that were stretched by 1.21 to 1.9 were wrong on four of five, others right on all seven.
  std::vector<Eigen::Index> listEnlarged() const;
};

/// A map from features to parameters by a forward surrogate, inverted for each measurement. A fitted,
/// immutable value.
struct Surrogate {
  std::shared_ptr<const ForwardSurrogate> forward;
  Eigen::VectorXd center, half_width;  ///< m, of the sampled box
  Eigen::Index parameters = 0;         ///< p: the first variables of a point, which are reported
  Eigen::Index unknown = 0;            ///< u: with the nuisance parameters, which are marginalised
  BoxPrior prior;                      ///< of the unknowns
  SurrogateValidation validation;

  /// Mean and standard deviation (p) of the parameters, in their units, for moments of normalised unknowns.
  void convertMoments(const gp::Moments& normalised, Eigen::VectorXd& mean, Eigen::VectorXd& stddev) const;

  /// What is inferred that is less certain than the prior alone, because two answers far apart fit or the
  /// factor of standard deviations is large, is drawn towards its mean until it is as certain
  /// (shrinkToBounds): an interval of it still holds what it says, as it reaches over the bounds.
  void shrinkToPrior(Eigen::Ref<Eigen::VectorXd> mean, Eigen::Ref<Eigen::VectorXd> stddev) const;

  /// The prior's mean (p, in the parameters' units), moved within the bounds.
  Eigen::VectorXd calcPriorCenter() const;

  /// The standard deviations (p, in the parameters' units) that a measurement allows, from those that the
  /// noise of the scores leaves of normalised unknowns (u): times validation.limit_scale, for what other
  /// scores would say.
  Eigen::VectorXd calcLimit(const Eigen::VectorXd& noise_stddev) const;

  /// Features (d x n, finite) and known inputs (m - u x n) -> mean and standard deviation of the parameters
  /// (p x n), before shrinkToPrior(), with what the measurements would allow without the surrogate's errors.
  /// The result does not depend on the number of threads. Throws std::invalid_argument for sizes that do not
  /// fit. Cost: that of ScoreInversion, some ms a column.
  Estimates invert(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs = {},
                   int threads = 1) const;
  /// The same after shrinkToPrior().
  Estimates predict(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs = {},
                    int threads = 1) const;
};

}  // namespace twinmap
