#pragma once

#include <Eigen/Core>

namespace twinmap {

/// Correlation matrix R (p x p) of standardised residuals z (p x n) of mean zero:
///   R_ij = sum z_i z_j / sqrt(sum z_i^2 sum z_j^2).
/// With fewer samples than parameters, or residuals that depend on each other linearly, that is singular: it
/// is then shrunk towards the identity, (1 - w) R + w I, by the least w that lifts its least eigenvalue to
/// 1e-6. So it is always positive definite, its diagonal 1. A parameter whose residuals are all 0 is
/// uncorrelated with the others. O(p^2 n).
Eigen::MatrixXd calcResidualCorrelation(const Eigen::MatrixXd& standardised_residuals);

}  // namespace twinmap
