#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/derived/value_distribution.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/model/curve.hpp"

namespace twinmap {

/// The quantities that an experiment derives from its p updating parameters. Immutable, for any number of
/// threads.
class DerivedQuantities {
 public:
  /// Of a checked experiment (checkDerived()).
  explicit DerivedQuantities(const ExperimentSpec& experiment);

  Eigen::Index count() const { return static_cast<Eigen::Index>(specs_.size()); }
  Eigen::Index countParameters() const { return lower_.size(); }

  /// As parameters that tables show: their bounds are the range over the box (of all corners, for at most 12
  /// parameters, and 1000 points within); errors are relative to the value, or to the range where that holds
  /// 0.
  const std::vector<ParameterSpec>& getSpecs() const { return specs_; }

  /// What defines one name after another: of the constants that follow from the parameters, then of the
  /// quantities. Places of names: the parameters', then these.
  std::vector<BoundExpression> listExpressions() const;

  /// The values (q) at a point (p); NaN or infinite where an expression is not defined there. About 0.1 us an
  /// operation.
  Eigen::VectorXd calc(const Eigen::Ref<const Eigen::VectorXd>& point) const;

  /// At the columns of p x n: q x n.
  Eigen::MatrixXd calcAll(const Eigen::MatrixXd& points) const;

  /// Derivatives (q x p) at a point, by central differences over 2e-6 of the widths of the bounds: rounding
  /// and curvature both leave some 1e-10 of what a quantity changes over the box.
  Eigen::MatrixXd calcGradients(const Eigen::VectorXd& point) const;

  /// What follows from a normal distribution of the parameters. Of each quantity f with the gradient g, along
  /// the line mean + z C g / sqrt(g' C g), z standard normal: the parameters that are likeliest for each
  /// value of f (to first order), so that a monotone function of one parameter has the exact quantiles, and
  /// that what is well determined (m L, where m and L alone are not) stays so although its curvature along
  /// the undetermined direction would spread it over draws. What is neglected is the curvature across that
  /// line. Points beyond the bounds are taken at them. Where the gradient is 0, 2000 draws instead. Cost: 241
  /// + 2 p values of each quantity.
  std::vector<ValueDistribution> propagate(const Eigen::VectorXd& mean,
                                           const Eigen::MatrixXd& covariance) const;

  /// The same of each component of a mixture, in its proportion.
  std::vector<ValueDistribution> propagate(const Mixture& mixture) const;

  /// The same of an estimate: of its mixture or ridge where it is one, else of its normal distribution.
  std::vector<ValueDistribution> propagate(const Estimate& estimate) const;

 private:
  struct Nodes {
    Eigen::MatrixXd values;   ///< q x k
    Eigen::VectorXd weights;  ///< k, the same for all quantities
  };
  Nodes calcNodes(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) const;
  Eigen::VectorXd calcAlong(Eigen::Index quantity, const Eigen::VectorXd& mean,
                            const Eigen::VectorXd& way) const;
  Eigen::VectorXd calcDrawn(Eigen::Index quantity, const Eigen::VectorXd& mean,
                            const Eigen::MatrixXd& covariance) const;
  void findRanges();

  NamedValues<double> names_;
  std::vector<BoundExpression> constants_, expressions_;
  std::vector<ParameterSpec> specs_;
  Eigen::VectorXd lower_, upper_;
};

/// How tables and answers state the distribution of each quantity (q): its 95 % interval leaves 2.5 % on
/// either side, or as much as a normal distribution's of `factor` standard deviations.
struct DerivedEstimate {
  Eigen::VectorXd mean, stddev, lower95, upper95;
};
DerivedEstimate summarize(const std::vector<ValueDistribution>& distributions, double factor = kNormal95);

/// The largest factor of an estimate's intervals: that of what is derived from it. A normal distribution's
/// along a ridge, whose distribution is known.
IntervalFactor findLargestFactor(const Estimate& estimate);

}  // namespace twinmap
