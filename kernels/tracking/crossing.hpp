#pragma once

#include <limits>

namespace twinmap::tracking {

/// What is known of a level now and of how it goes on.
struct Outlook {
  double mean = 0.0, stddev = 0.0;           ///< of the level
  double slope = 0.0, slope_stddev = 0.0;    ///< per unit of time
  double rate = 0.0, rate_log_stddev = 0.0;  ///< median variance per unit of time, and of its logarithm
};

/// Quantiles of the time until a level first passes a limit; infinite of what has less probability.
struct Crossing {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double median = kNever, lower = kNever, upper = kNever;  ///< 95 %
};

/// The probability that the level has passed the limit within a time t: that of Brownian motion with drift m.
///   Phi((m t - b) / sqrt(q t)) + exp(2 m b / q) Phi(-(b + m t) / sqrt(q t))
/// at a distance b (inverse Gaussian). Level and slope are integrated out in closed form in the first term,
/// all else by Gauss-Hermite quadrature.
double calcPassed(const Outlook& outlook, double limit, bool is_below, double time);

/// is_below: the limit is one that the level must stay above. `longest`: a time beyond which is never.
Crossing findCrossing(const Outlook& outlook, double limit, bool is_below, double longest);

}  // namespace twinmap::tracking
