#pragma once

#include <Eigen/Core>

#include "kernels/gp/gaussian_process.hpp"

namespace twinmap::gp {

/// What each training sample would have been predicted as, had it been left out (hyperparameters kept; the
/// mean's coefficients fitted anew).
struct LeaveOneOut {
  Eigen::VectorXd residual;     ///< y_i minus its prediction, target units
  Eigen::VectorXd stddev;       ///< of that prediction, noise included
  Eigen::VectorXd log_density;  ///< of y_i under it, nats
  double total_log_density = 0.0;
  double coverage95 = 0.0;  ///< fraction of |residual| <= 1.96 stddev
  double root_mean_square = 0.0;
};

/// In closed form from one factor (Rasmussen and Williams eqs. 5.10 to 5.12, with the mean integrated out):
///   residual_i = alpha_i / P_ii,   variance_i = 1 / P_ii,   P = K^-1 - K^-1 H' A^-1 H K^-1.
/// Jitter counts as noise. Cost: n^3 / 3 flops.
LeaveOneOut calcLeaveOneOut(const GaussianProcess& process);

}  // namespace twinmap::gp
