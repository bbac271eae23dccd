#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The 50 %, 68 % and 95 % intervals of a normal distribution are mean +- so many standard deviations.
constexpr double kNormal50 = 0.674489750196082, kNormal68 = 0.994457883209753, kNormal95 = 1.959963984540054;

/// Errors or draws of which a factor and quantiles are known to 2 %.
constexpr int kManyErrors = 2000;

/// Half widths of a parameter's intervals of 50 % and 95 % in standard deviations: conformal ones, sized by
/// held-out errors, where these are not normal.
struct IntervalFactor {
  double of50 = kNormal50, of95 = kNormal95;

  /// The |z| of a normal distribution whose interval is as probable as one of half width `depth`: linear
  /// between the two, in proportion outside.
  double calcEquivalentZ(double depth) const;
};

/// Those of p parameters where errors are not normal: p x 1 of an estimator or an estimate, p x n of n
/// estimates. Empty where they are.
struct IntervalFactors {
  Eigen::MatrixXd of50{}, of95{};

  bool isGiven() const { return of95.size() > 0; }
  IntervalFactor get(Eigen::Index parameter, Eigen::Index estimate = 0) const {
    return isGiven() ? IntervalFactor{of50(parameter, estimate), of95(parameter, estimate)}
                     : IntervalFactor{};
  }
  void set(Eigen::Index parameter, Eigen::Index estimate, const IntervalFactor& factor) {
    of50(parameter, estimate) = factor.of50;
    of95(parameter, estimate) = factor.of95;
  }
  /// Of an estimate that is a normal distribution among those that are not.
  void setNormal(Eigen::Index estimate) {
    if (isGiven()) {
      of50.col(estimate).setConstant(kNormal50);
      of95.col(estimate).setConstant(kNormal95);
    }
  }
};

/// An estimator's for each of so many estimates.
IntervalFactors replicate(const IntervalFactors& factors, Eigen::Index estimates);

/// A parameter's in each estimate; empty where none is given.
std::vector<IntervalFactor> takeFactors(const IntervalFactors& factors, Eigen::Index parameter);

/// Binomial standard error of an empirical proportion of so many independent samples with this probability.
double calcProportionError(double probability, double samples);

/// What a further value is below with this probability, given n others in ascending order: the ceil(p (n +
/// 1))-th of them, or the last (split conformal prediction: Lei, G'Sell, Rinaldo, Tibshirani and Wasserman,
/// JASA 113, 2018).
double calcConformalQuantile(const Eigen::VectorXd& sorted, double probability);

/// The factors with which a parameter's intervals hold what they say, from how many standard deviations the
/// truths of held-out estimates lie from their means (`depths`): conformal quantiles. Those of the normal
/// distribution unless the errors have another shape: unless its intervals, stretched so that those of 68 %
/// hold what they say, still hold more or fewer by more than two standard errors of `samples` independent
/// estimates, of which there may be fewer than depths. Else quantiles only add chance; how wide errors are is
/// known by the factor of standard deviations, with its own caution.
IntervalFactor calcIntervalFactor(const Eigen::VectorXd& depths, double samples);

/// The factor by which standard deviations must be multiplied so that both the 95 % and the 68 % interval
/// hold, from the absolute errors of samples that took no part in the training, each over its standard
/// deviation: the larger of the two conformal quantiles, each over that of the normal distribution. Below 1
/// only where the quantiles' upper confidence limits (97.5 %) are, and then the larger of these: claiming
/// less than the map does must be beyond doubt. More than 2000 samples leave little doubt: of errors with
/// heavier tails than normal ones, 50 % intervals would hold too much then, and the factor is one by which
/// 50 % intervals hold as much too much as 95 % intervals too little, the latter counting twice. Errors with
/// lighter tails keep the factor of the 68 % interval.
double calcStddevScale(const Eigen::VectorXd& absolute_z);

/// Geometric mean of each row of standard deviations.
Eigen::VectorXd calcTypicalStddev(const Eigen::MatrixXd& stddev);

}  // namespace twinmap
