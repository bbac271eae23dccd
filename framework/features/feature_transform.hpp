#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/spec/experiment_spec.hpp"

namespace twinmap {

/// From features to the inputs of the inverse map: (x - offset) / scale, element by element. Fitted once, on
/// the training features, then a plain value.
struct FeatureTransform {
  Eigen::VectorXd offset;  ///< d, in the features' units
  Eigen::VectorXd scale;   ///< d, > 0

  /// Features (d x n) -> inputs (d x n).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& features) const;
};

/// Fits the steps to training features (d x n, n >= 2). Z-score: offset is the mean, scale the standard
/// deviation (1/(n-1)); a constant feature has scale 1, so that it says nothing instead of NaN.
FeatureTransform fitTransform(const std::vector<TransformStep>& steps, const Eigen::MatrixXd& features);

}  // namespace twinmap
