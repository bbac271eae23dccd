#pragma once

#include <Eigen/Core>

#include "framework/data/reduction/affine_step.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Directions of the variance of data, largest first.
struct PrincipalComponents {
  Eigen::MatrixXd directions;  ///< d x min(d, n), orthonormal columns, each with its largest entry positive
  Eigen::VectorXd variances;   ///< min(d, n), descending, with 1/(n-1)
};

/// Of centred data (d x n, rows of zero mean, n >= 2), by the eigenvectors of the smaller of X X' and X' X.
PrincipalComponents calcPrincipalComponents(const Eigen::MatrixXd& centered);

/// Turns each column so that its largest entry is positive.
void fixSigns(Eigen::MatrixXd& directions);

/// The upper edge (1 + sqrt(d / n))^2 of the eigenvalues of the sample covariance of n samples of unit white
/// noise in d dimensions (Marchenko and Pastur 1967).
double calcMarchenkoPasturEdge(Eigen::Index dimensions, Eigen::Index samples);

/// Projects features (d x n, n >= 2) on their principal components: as many as asked for, or as explain a
/// fraction of the variance, or those whose variance stands above the Marchenko-Pastur edge, the largest of
/// unit noise alone; at least one is kept. Throws std::invalid_argument if more are asked for than there are.
/// Cost: min(d, n)^3 + d n min(d, n) flops.
AffineStep fitPrincipalComponents(const PrincipalComponentsSpec& spec, const Eigen::MatrixXd& features);

}  // namespace twinmap
