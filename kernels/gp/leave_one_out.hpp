#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/gp/gaussian_process.hpp"

namespace twinmap::gp {

/// What each training sample would have been predicted as, had it been left out (hyperparameters kept; the
/// mean's coefficients fitted anew).
struct LeaveOneOut {
  Eigen::VectorXd residual;     ///< y_i minus its prediction, target units
  Eigen::VectorXd stddev;       ///< of that prediction, noise included and never below it
  Eigen::VectorXd log_density;  ///< of y_i under it, nats
  double total_log_density = 0.0;
  double coverage95 = 0.0;  ///< fraction of |residual| <= 1.96 stddev
  double root_mean_square = 0.0;
};

/// Groups of samples that are left out together, each sample in exactly one. Draws of the noise of one
/// simulation belong together: a draw left out alone would be predicted from its siblings.
using SampleGroups = std::vector<std::vector<Eigen::Index>>;

/// Column j + i n / draws in group j.
SampleGroups makeDrawGroups(Eigen::Index samples, int draws);

/// Every group left out, in closed form from one factor (Rasmussen and Williams eqs. 5.10 to 5.12, with the
/// mean integrated out). For a group g, with P_gg its block of the precision matrix P,
///   residual_g = P_gg^-1 alpha_g,   covariance_g = P_gg^-1,   P = K^-1 - K^-1 H' A^-1 H K^-1;
/// of the covariance the diagonal is kept: each sample's own prediction. Jitter counts as noise. Cost:
/// n^3 / 3 flops, shared by `threads` threads; the result does not depend on their number.
LeaveOneOut calcLeaveGroupsOut(const GaussianProcess& process, const SampleGroups& groups, int threads = 1);

/// Every sample left out by itself.
LeaveOneOut calcLeaveOneOut(const GaussianProcess& process);

/// A group of samples without itself: y minus the prediction, and the variance of that prediction.
struct GroupPrediction {
  Eigen::VectorXd residual;
  Eigen::VectorXd variance;  ///< noise included
};

/// The prediction of a group from its block of the precision matrix and its part of alpha. The variance is at
/// least `noise_variance`, whatever rounding leaves of it.
GroupPrediction predictGroup(const Eigen::MatrixXd& precision, const Eigen::VectorXd& alpha,
                             double noise_variance);

/// Everything that follows from residuals and standard deviations.
LeaveOneOut summarizeLeaveOneOut(const Eigen::VectorXd& residual, const Eigen::VectorXd& stddev);

/// Throws std::invalid_argument unless every sample is in exactly one group.
void checkGroups(const SampleGroups& groups, Eigen::Index samples);

}  // namespace twinmap::gp
