#pragma once

#include "kernels/tracking/belief.hpp"

namespace twinmap::tracking {

/// Rates that a walk may have, as standard deviations of it between two measurements over that of a
/// measurement. They go from what 10^5 measurements would not show, in octaves, to what hides all memory.
constexpr int kRates = 14;
double getRateRatio(int g);

/// What is known of the rate of one parameter: a filter for each rate, all others moving at theirs.
struct RateFilters {
  Eigen::Index parameter = 0;
  std::vector<Belief> beliefs;  ///< kRates
  Eigen::VectorXd log_weights;  ///< kRates, of their predictions so far and the prior; the largest is 0
};

/// sqrt(ratio) exp(-ratio / 2) over the logarithm, so that rates beyond some standard deviations of a
/// measurement are taken only where they are seen. Of priors that are uniform below, or have a share at 0,
/// bands of slow walks are too narrow (docs/benchmarks/tracking.md).
Eigen::VectorXd makeLogRatePrior();

/// Weights, of sum 1, of ratios between those of the filters.
/// log_weights are interpolated by a parabola
/// through each three.
struct RatePosterior {
  Eigen::VectorXd octaves;  ///< from the lowest ratio on
  Eigen::VectorXd weights;

  /// kRates, of the filters: what lies between two is shared by them.
  Eigen::VectorXd calcFilterWeights() const;
  /// Mean and standard deviation of ratio^2, the variance of the walk over that of a measurement.
  double calcMeanSquare() const;
  double calcSquareStddev() const;
};
RatePosterior calcRatePosterior(const RateFilters& filters);

/// Median and 95 % interval of the ratio.
struct RateEstimate {
  double median = 0.0, lower = 0.0, upper = 0.0;
  double log_stddev = 0.0;  ///< of its natural logarithm
};
RateEstimate estimateRate(const RatePosterior& posterior);

/// Mean and variance of the parameter over all rates.
struct Moments {
  double mean = 0.0, variance = 0.0;
};
Moments calcMoments(const RateFilters& filters, const RatePosterior& posterior);

}  // namespace twinmap::tracking
