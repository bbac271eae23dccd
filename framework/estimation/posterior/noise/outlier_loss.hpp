#pragma once

#include <Eigen/Core>

namespace twinmap {

/// A standard deviation about 0 from the median of the absolute values.
double calcRobustSize(const Eigen::VectorXd& values);

/// -2 log likelihood, relative to that of noise at 0, of a residual (in noise standard deviations) that is
/// noise or, once in a hundred, anything: Cauchy's distribution of ten standard deviations.
double calcOutlierLoss(double residual);

/// The weight of a residual's square that gives the slope of that.
double calcOutlierWeight(double residual);

/// The size s of noise that is likeliest for residuals (n) of which some may be outliers: n log s^2 + sum of
/// calcOutlierLoss(r / s) is least. That loss at it is the one with s integrated out under a prior uniform
/// in its logarithm, but for a summand: exactly for normal noise, as Laplace's approximation elsewhere. From
/// the median of their absolute values on; at least the smallest normal number.
struct OutlierSize {
  double size = 1.0;
  double loss = 0.0;
};
OutlierSize findOutlierSize(const Eigen::VectorXd& residual);

}  // namespace twinmap
