#pragma once

#include <Eigen/Core>
#include <utility>

namespace twinmap {

/// Weighted draws of a distribution of u parameters, in their units, that ends at bounds.
struct BoundedDraws {
  Eigen::MatrixXd points;        ///< u x n; the parameters that are reported come first
  Eigen::VectorXd weights;       ///< n, sum 1
  Eigen::VectorXd lower, upper;  ///< u, the bounds; all draws are within

  bool isGiven() const { return weights.size() > 0; }

  /// Quantiles of a parameter (k) at probabilities (k, in [0, 1]).
  Eigen::VectorXd calcQuantiles(Eigen::Index parameter, const Eigen::VectorXd& probabilities) const;

  /// The interval of a parameter that holds the probability, in (0, 1), and leaves as much on either side.
  /// Where the density at one bound is at least that at the end of the interval that begins there, it is that
  /// one: a friction that may well be 0 is below a limit, not between two. The truth at a bound, where no
  /// interval with two sides would ever hold it, is then held as often as others.
  /// Where other parameters may well be 0, as their 95 % intervals end at a bound of 0, it reaches as far as
  /// it would without them: friction that is absent leaves its share of the losses to damping, and the
  /// posterior, which gives it none, would hold the damping of such a machine .81 of the time.
  std::pair<double, double> findInterval(Eigen::Index parameter, double probability) const;
};

}  // namespace twinmap
