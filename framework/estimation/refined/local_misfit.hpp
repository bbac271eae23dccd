#pragma once

#include <Eigen/Core>

#include "framework/experiment/points/prior.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The misfit and its linear model at a point `at` (s, half-widths): with the whitened residual r and its
/// derivatives -J,
///   misfit(at + step) ~ misfit - 2 step' descent + step' (information + prior) step.
/// The prior is that of the box, as a normal distribution of its variance (3 |at|^2), but for parameters
/// whose distribution ends by itself (Prior::hasRange), and what else is known (BesideBounds).
struct LocalMisfit {
  SampleStatus status;  ///< if not ok, the rest is empty
  Eigen::VectorXd at;
  double chi_square = 0.0;      ///< |r|^2
  double misfit = 0.0;          ///< chi_square + that of the prior
  Eigen::Index residuals = 0;   ///< k
  Eigen::MatrixXd information;  ///< J'J, s x s
  Eigen::VectorXd descent;      ///< J'r and that of the prior
  Eigen::VectorXd residual;     ///< r, k
  Eigen::MatrixXd jacobian;     ///< J, k x s
  Eigen::VectorXd box{};        ///< s, information of the bounds; empty: 3 each
  PriorMisfit beside{};         ///< of the prior but for the bounds, in half-widths; sizes 0: uniform

  /// Degrees of freedom: residuals less the parameters that they, not the box, determine (trace of
  /// J'J (J'J + prior)^-1), at least one.
  double calcDegrees() const;

  Eigen::MatrixXd calcHessian() const;  ///< information + prior
  /// The same without the bounds, where these are taken into account by themselves.
  double calcMisfitWithin() const { return chi_square + beside.misfit; }
  Eigen::VectorXd calcDescentWithin() const;
  Eigen::MatrixXd calcInformationWithin() const;
  Eigen::MatrixXd calcCovariance() const;  ///< its inverse, in half-widths
};

}  // namespace twinmap
