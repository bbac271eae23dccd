#pragma once

#include <Eigen/Core>

#include "framework/estimation/interval_factor.hpp"
#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// What recordings of one machine that scatter say of a parameter.
struct ScatterEstimate {
  double mean = 0.0;     ///< over the recordings
  double stddev = 0.0;   ///< of this mean
  double scatter = 0.0;  ///< standard deviation between recordings that their own does not explain
  double ratio = 0.0;    ///< of their scatter to that which their own explains: about 1 where they agree
  int degrees = 0;       ///< of freedom of the scatter: one less than recordings
  Bounds bounds{-kInfinity, kInfinity, {}};  ///< of the parameter, at which intervals end

  /// Of what one recording more would say, if that knew the parameter exactly.
  double calcStddevOfNext() const;
  /// Of intervals about the mean: a Student distribution's, as recordings are few.
  IntervalFactor calcFactor() const;
  /// Standard deviation of a recording of which its own is `own`: with the scatter.
  double widen(double own) const;
  /// Of intervals of that: the fewer degrees of freedom, the more of it is scatter (Welch and Satterthwaite).
  IntervalFactor calcFactor(double own) const;
};

/// The mean of values that scatter more than their standard deviations say. The variance between them is
/// Paule and Mandel's (1982), for standard deviations that differ by orders of magnitude. That of the mean is
/// Hartung and Knapp's (2001), for few values. At least two values; stddevs above 0.
ScatterEstimate combineScattered(const Eigen::VectorXd& values, const Eigen::VectorXd& stddevs);

/// Probability of as large a scatter of values that agree: of Cochran's Q, their sum of squares about the
/// weighted mean, which is chi-square then.
double calcScatterPValue(const ScatterEstimate& scatter);

}  // namespace twinmap
