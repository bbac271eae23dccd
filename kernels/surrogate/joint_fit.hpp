#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/surrogate/slope_covariance.hpp"

namespace twinmap::gp {

/// Weights of a process that values and slopes determine, and its values at points left out with all that is
/// known there. With K the joint covariance, H' the terms and y values and slopes times length scales,
///   weights = P y,   P = K^-1 - K^-1 H' (H K^-1 H')^-1 H K^-1,
/// and with P_ii the block of point i (its value and slopes), e_i and variance_i are the first element of
/// P_ii^-1 (P y)_i and of the diagonal of P_ii^-1.
struct JointFit {
  Eigen::MatrixXd weights;       ///< n + u m x r
  Eigen::MatrixXd coefficients;  ///< of the trend, q x r
  Eigen::MatrixXd residual;      ///< e, n x r
  Eigen::VectorXd variance;      ///< n, of a process of unit variance, nugget included
};

/// False if a matrix is not positive definite. Cost: 2 / 3 (n + u m)^3 flops.
bool fitJointly(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, const SlopeData& slopes,
                JointFit& fit);

/// Values, then slopes times length scales: n + u m x r.
Eigen::MatrixXd stackValues(const Eigen::MatrixXd& values, const SlopeData& slopes,
                            const Eigen::VectorXd& length_scales);

/// Rows of one of n points: that of its value and, where they are known, of its slopes.
std::vector<Eigen::Index> listJointRows(Eigen::Index point, Eigen::Index points, const SlopeData& slopes);

/// Residual and variance of a point left out, from its rows and its block P_ii; weights are there already.
void leaveOut(Eigen::Index point, const std::vector<Eigen::Index>& rows, const Eigen::MatrixXd& block,
              JointFit& fit);

/// The mean over functions and points left out of -log N(e_ij; 0, 1 + t_j variance_i), without
/// log(2 pi) / 2, t_j the mean over i of e_ij^2 / variance_i: as LeftOutDensity, times n r.
double calcLeftOutDensity(const JointFit& fit);

}  // namespace twinmap::gp
