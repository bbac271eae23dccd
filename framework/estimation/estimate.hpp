#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/estimation/bounded_draws.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/mixture.hpp"

namespace twinmap {

/// What made an estimate: a trained estimator, a refinement on the simulator, or draws of the posterior.
enum class EstimationMethod { kEstimator, kRefined, kPosterior };

/// "estimator", "refined", "posterior".
const char* toString(EstimationMethod method);

/// The probability of an interval.
enum class Coverage { k50, k95 };

/// Bounds of one interval of each parameter: p each.
struct Bounds95 {
  Eigen::VectorXd lower, upper;
};

/// What is believed of p parameters after one measurement: a normal distribution, a mixture of them, or draws
/// of any, in the parameters' units. Whoever shows intervals takes them from here.
struct Estimate {
  Eigen::VectorXd mean{}, stddev{};  ///< p; empty where nothing is believed
  /// p, what the measurement allows as the estimator predicts it; empty where it cannot.
  Eigen::VectorXd limit_stddev{};
  /// p, what was known before the measurement; empty where that is the bounds alone.
  Eigen::VectorXd prior_stddev{};
  Eigen::MatrixXd correlation{};  ///< p x p, of the errors
  Mixture mixture{};              ///< where it is one, whose mean and stddev are above
  BoundedDraws draws{};           ///< where it is known by draws; a mixture then has their separate modes
  IntervalFactors interval_factors{};  ///< of intervals, where they are not those of the distribution above
  Bounds95 limits{};                   ///< at which the intervals of a normal distribution end; or empty
  /// Where refinement followed a ridge: the joint distribution along it, of which mean, stddev and intervals
  /// are those of each parameter. What is derived from several follows from it.
  Mixture ridge{};
  EstimationMethod method{};
  const char* estimator = "";           ///< Estimator::getKind() of a trained one
  std::vector<std::string> statuses{};  ///< listStatuses(); empty where nobody has judged
  /// k, the features and known inputs as the estimator sees them, for a trust model; empty where refined.
  Eigen::VectorXd inputs{};

  /// "gp", "surrogate", "network", ...; "refined", "posterior".
  const char* getMethod() const {
    return method == EstimationMethod::kEstimator ? estimator : toString(method);
  }

  bool isGiven() const { return mean.size() > 0; }
  /// Whether several values that lie apart fit.
  bool isMultimodal() const;
  bool isRefined() const { return method == EstimationMethod::kRefined; }

  /// p x p, symmetric.
  Eigen::MatrixXd calcCovariance() const;

  /// A parameter's intervals, ascending: one, mean +- its factor times stddev, the smallest set of a mixture,
  /// or one between quantiles of draws (BoundedDraws::findInterval) unless their modes lie apart. Cost: of a
  /// mixture some 0.2 ms.
  Intervals findIntervals(Eigen::Index parameter, Coverage coverage) const;

  /// The outermost bounds of all parameters' 95 % intervals.
  Bounds95 calcBounds95() const;

  /// By how much standard deviations are above what the measurement allows (p); empty where that is not
  /// known.
  Eigen::VectorXd calcRatioToLimit() const;

  /// One that fits: mean and stddev alone, or those of the likeliest component.
  Estimate takeLikeliest() const;
};

/// Estimates of n measurements (p x n each).
struct Estimates {
  Eigen::MatrixXd mean, stddev;
  /// p x p, of the errors: one for all measurements, or one for each; empty where the estimator's own
  /// (Estimator::getResidualCorrelation) holds.
  std::vector<Eigen::MatrixXd> correlations{};
  /// Of each measurement, where the estimator gives mixtures; else empty.
  std::vector<Mixture> mixtures{};
  IntervalFactors interval_factors{};
  std::vector<Mixture> ridges{};      ///< Estimate::ridge of each, where any has one; else empty
  Eigen::MatrixXd limit_stddev{};     ///< what the measurements allow, as the estimator predicts it; or empty
  std::vector<BoundedDraws> draws{};  ///< Estimate::draws of each, where any has some; else empty
  /// Where figures of n samples are not of one estimate of each: of how many samples each stands for. Further
  /// columns than n are then other estimates of the samples that `repeated` names, and may stand for less
  /// than none: a few samples tell how figures of both kinds of estimates differ. Empty: each for its own.
  Eigen::VectorXd weights{};
  std::vector<Eigen::Index> repeated{};

  /// Of values of the samples (r x n) the one beside each column.
  Eigen::MatrixXd repeat(const Eigen::MatrixXd& values) const;
};

/// In other units, as convert() of a mixture; the mean and standard deviation of a mixture follow from it.
void convert(const Eigen::VectorXd& center, const Eigen::VectorXd& unit, const Eigen::VectorXd& stddev_scale,
             Estimates& estimates);

/// An estimate that knows less of a parameter than its bounds do, its standard deviation being more than
/// their half width, is drawn towards their center until it is that: what a network extrapolates to may be
/// thousands of widths away. Bounds alone leave .58 of the half width, so that estimates that are informative
/// at all are left as they are. All p numbers each; the result does not allocate.
void shrinkToBounds(const Eigen::VectorXd& center, const Eigen::VectorXd& half_width,
                    Eigen::Ref<Eigen::VectorXd> mean, Eigen::Ref<Eigen::VectorXd> stddev);

/// The same of each measurement, and of its mixture.
void shrinkToBounds(const Eigen::VectorXd& center, const Eigen::VectorXd& half_width, Estimates& estimates);

/// How far a parameter's truths (p x n) lie from the estimates, in standard deviations (n): of mixtures,
/// calcDepth(), at some 0.1 ms a measurement.
Eigen::VectorXd calcDepths(const Estimates& estimates, const Eigen::MatrixXd& truth, Eigen::Index parameter);

/// The factors with which intervals hold what they say (calcIntervalFactor()) of each parameter's truths (p x
/// n), `draws` of each simulation; empty where those of normal distributions do, and for fewer than 400
/// simulations, whose quantiles are chance: 2.5 % of those of 50 % intervals, 1 % of those of 95 %.
IntervalFactors calcIntervalFactors(const Estimates& estimates, const Eigen::MatrixXd& truth, int draws);

/// The correlation matrix of a covariance (p x p, positive diagonal).
Eigen::MatrixXd calcCorrelation(const Eigen::MatrixXd& covariance);

/// Correlation matrix R (p x p) of standardised residuals z (p x n) of mean zero:
///   R_ij = sum z_i z_j / sqrt(sum z_i^2 sum z_j^2).
/// With fewer samples than parameters, or residuals that depend on each other linearly, that is singular: it
/// is then shrunk towards the identity, (1 - w) R + w I, by the least w that lifts its least eigenvalue to
/// 1e-6. So it is always positive definite, its diagonal 1. A parameter whose residuals are all 0 is
/// uncorrelated with the others. O(p^2 n).
Eigen::MatrixXd calcResidualCorrelation(const Eigen::MatrixXd& standardised_residuals);

/// With more than this share of the standard deviation that was there before, a parameter is hardly better
/// known.
constexpr double kUninformativeShare = 0.9;

/// Whether one of the parameters is hardly better known than before. Both of one size and unit.
inline bool isUninformative(const Eigen::Ref<const Eigen::VectorXd>& stddev,
                            const Eigen::Ref<const Eigen::VectorXd>& prior_stddev) {
  return (stddev.array() > kUninformativeShare * prior_stddev.array()).any();
}

}  // namespace twinmap
