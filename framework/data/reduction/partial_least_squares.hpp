#pragma once

#include <Eigen/Core>

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/reduction/affine_step.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Directions in which centred features x have most covariance with centred targets y.
struct PartialLeastSquares {
  Eigen::MatrixXd rotations;  ///< R, d x k: scores t = R' x, uncorrelated over the samples
  Eigen::MatrixXd loadings;   ///< Q, p x k: y is about Q t; the first columns serve fewer components
};

/// PLS2 with deflation of the features (NIPALS, Wold 1975), the dominant direction of each cross-covariance
/// by an eigenvector instead of iteration. `features` d x n and `targets` p x n, rows of zero mean. Stops
/// before `components` where the features left over have no covariance with the targets. Cost: k d n (2 p +
/// 4) flops.
PartialLeastSquares calcPartialLeastSquares(const Eigen::MatrixXd& features, const Eigen::MatrixXd& targets,
                                            Eigen::Index components);

/// Squared errors of the linear prediction of the standardised parameters with 1, 2 ... `most` components, by
/// cross-validation over `folds` blocks of successive simulations; all replicates of a simulation are in one
/// fold. folds x components, each entry the mean over the fold's samples, summed over the parameters.
Eigen::MatrixXd calcCrossValidationErrors(const LabelledFeatures& samples, Eigen::Index most,
                                          Eigen::Index folds);

/// Projects features on their PLS directions towards the standardised parameters, each direction with its
/// largest entry positive. Automatic rank: the fewest components whose cross-validated error (10 folds, at
/// most 30 components) is within one standard error of the smallest (Breiman et al. 1984). Throws
/// std::invalid_argument if more components are asked for than there are.
AffineStep fitPartialLeastSquares(const PartialLeastSquaresSpec& spec, const LabelledFeatures& samples);

}  // namespace twinmap
