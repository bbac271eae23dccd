#pragma once

#include <Eigen/Core>

#include "kernels/gp/model.hpp"

namespace twinmap::gp {

/// cov(f(x_i), f(z_j)) for inputs already centred: m x n from `left` (d x m) and `right` (d x n), both given
/// divided by their length scales; the linear term multiplies them back. `weights`, if given, becomes
/// -2 dcov/dq (see evaluateRadial). Cost: 2 m n d flops.
Eigen::MatrixXd calcCrossCovariance(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                    const Eigen::MatrixXd& left, const Eigen::MatrixXd& right,
                                    Eigen::MatrixXd* weights = nullptr);

/// cov(f(x), f(x)) of each column of `inputs` (centred and divided by the length scales).
Eigen::VectorXd calcPriorVariance(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                  const Eigen::MatrixXd& inputs);

/// l of each feature.
Eigen::VectorXd lengthScaleOfFeatures(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                                      Eigen::Index feature_count);

}  // namespace twinmap::gp
