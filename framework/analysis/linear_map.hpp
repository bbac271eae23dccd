#pragma once

#include <Eigen/Core>

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/reduction/feature_transform.hpp"
#include "framework/estimation/estimate.hpp"

namespace twinmap {

/// An inverse map that is linear in x, the transformed features and the known inputs: p = offset + slopes x,
/// with the residuals' standard deviation.
struct LinearMap {
  FeatureTransform transform;
  Eigen::VectorXd offset;  ///< p
  Eigen::MatrixXd slopes;  ///< p x k
  Eigen::VectorXd stddev;  ///< p, of the training residuals, with 1 / (n - k - 1)

  /// Features (d x m, untransformed) and known inputs (q x m) -> predictions (p x m each).
  Estimates predict(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs) const;
};

/// Least squares of the training parameters on the transformed features and known inputs, of minimum norm
/// where those are dependent. Cost: n k^2.
LinearMap trainLinearMap(const FeatureTransform& transform, const LabelledFeatures& samples);

}  // namespace twinmap
