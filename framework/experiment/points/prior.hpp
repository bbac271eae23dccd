#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// -2 log of a prior's density at a point, as a misfit with a linear model, as chi-square has one:
/// misfit(at + step) ~ misfit - 2 step' descent + step' information step.
struct PriorMisfit {
  double misfit = 0.0;          ///< 0 where the prior is uniform
  Eigen::VectorXd descent;      ///< u
  Eigen::MatrixXd information;  ///< u x u, positive semidefinite
};

/// The parameters whose priors are not uniform (k) as jointly normal, without their bounds.
struct NormalForm {
  std::vector<Eigen::Index> parameters;  ///< their places among the unknown
  Eigen::VectorXd mean, stddev;          ///< k, in the parameters' units
  Eigen::MatrixXd correlation;           ///< k x k
};

/// What is known of the unknown parameters before a measurement: a distribution of each within its bounds,
/// some of them jointly normal (or their logarithms). Immutable.
class Prior {
 public:
  /// unknown: u parameters. Throws ExperimentError for a group that names others, or parameters whose priors
  /// it cannot join, and for a covariance that is not positive definite.
  Prior(const std::vector<ParameterSpec>& unknown, const std::vector<PriorGroupSpec>& groups);

  /// Whether every parameter is uniform within its bounds.
  bool isUniform() const { return others_.empty() && normals_.empty(); }

  /// Whether a parameter's distribution ends by itself, as normal, lognormal and Student's do; the others,
  /// uniform ones among them, are what their bounds make them.
  bool hasRange(Eigen::Index parameter) const;

  /// log of the density at x (u, within the bounds, in the parameters' units), but for a summand.
  double calcLogDensity(const Eigen::VectorXd& x) const;

  /// The misfit of the density in the logarithm for lognormal and log-uniform priors, in the parameter for
  /// the others, so that the most probable point of a lognormal prior is its median.
  PriorMisfit calcMisfit(const Eigen::VectorXd& x) const;

  /// The point of the prior (u) at a point of the unit cube (u): the quantiles of each parameter, one after
  /// the other given those before it where they are correlated. Uniform points give draws of the prior; where
  /// bounds cut off a part of correlated ones, if each is kept with the probability calcShareWithin().
  Eigen::VectorXd calcPoint(const Eigen::VectorXd& unit) const;

  /// The product over the correlated parameters of how much of each, given those before it at
  /// calcPoint(unit), lies within its bounds: the density of the prior is in proportion to that of
  /// calcPoint() times it. 1 but for rounding where bounds cut off nothing.
  double calcShareWithin(const Eigen::VectorXd& unit) const;

  /// Mean and standard deviation of each parameter (u) within its bounds.
  Eigen::VectorXd calcMeans() const;
  Eigen::VectorXd calcStddevs() const;

  /// Mean and standard deviation of normal priors, and their correlation, as stated; of the others those
  /// within the bounds, and the correlation of their logarithms for lognormal ones.
  NormalForm calcNormalForm() const;

  /// The prior as information beside that of a measurement, at each of the points (u x n; u x u each, per
  /// width of the bounds): that of a normal distribution of the same variance, which is the logarithm's for
  /// lognormal and log-uniform priors, and of the same correlation; 12 for a uniform parameter. Empty where
  /// all are uniform, so that it is 12 everywhere.
  std::vector<Eigen::MatrixXd> calcInformation(const Eigen::MatrixXd& points) const;

 private:
  /// Normal, or of a normal logarithm.
  struct Normal {
    Eigen::Index parameter = 0;
    bool of_logarithm = false;
    double mean = 0.0, stddev = 1.0;

    double standardize(double x) const { return ((of_logarithm ? std::log(x) : x) - mean) / stddev; }
    double calcSlope(double x) const { return 1.0 / ((of_logarithm ? x : 1.0) * stddev); }
  };
  struct Other {
    Eigen::Index parameter = 0;
    PriorSpec prior;
  };

  /// Equally likely points of each parameter by itself (u x n).
  Eigen::MatrixXd listQuantiles() const;
  bool isOfLogarithm(Eigen::Index parameter) const;
  /// A normal parameter at the place u in (0, 1) of what its bounds leave of it, given those before it.
  struct Conditional {
    double lower, upper;  ///< the bounds, standardized
    double mean, spread;
  };
  Conditional condition(Eigen::Index k, const Eigen::VectorXd& independent) const;
  Eigen::VectorXd drawIndependent(const Eigen::VectorXd& unit) const;
  void addMarginal(Eigen::Index parameter, const std::optional<PriorSpec>& prior);
  void join(const std::vector<ParameterSpec>& unknown, const PriorGroupSpec& group);
  Eigen::VectorXd standardize(const Eigen::VectorXd& x) const;

  std::vector<Bounds> bounds_;
  std::vector<Normal> normals_;  ///< correlated or not
  std::vector<Other> others_;    ///< neither uniform nor normal
  Eigen::MatrixXd correlation_;  ///< of the standardized normal ones
  Eigen::MatrixXd lower_;        ///< its Cholesky factor
};

}  // namespace twinmap
