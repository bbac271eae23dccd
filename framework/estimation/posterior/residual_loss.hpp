#pragma once

#include <Eigen/Core>

namespace twinmap {

/// How the residuals of one measurement count.
enum class LossKind {
  kPlain,         ///< normal noise of the stated size
  kUnknownNoise,  ///< normal noise of a size that is not known: the stated ones times one factor
  kOutliers,      ///< normal noise of the stated size, but for a hundredth of samples that are anything
};

/// -2 log likelihood, but for a summand, of whitened residuals (k). The unknown factor is integrated out
/// under a prior that is uniform in its logarithm (Jeffreys), which leaves k log(r'r / k); an outlier has a
/// Cauchy distribution of ten noise standard deviations, so that spikes of 20 and of 500 are nothing unusual.
double calcLoss(LossKind kind, const Eigen::VectorXd& residual);

/// The weights (k) of the sum of squares that has the same slope there: k / r'r, or about 0 of an outlier.
Eigen::VectorXd calcLossWeights(LossKind kind, const Eigen::VectorXd& residual);

}  // namespace twinmap
