#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/reduction/affine_step.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// From features to the inputs of the inverse map: affine steps one after another. Fitted once, on the
/// training features, then a plain value.
struct FeatureTransform {
  std::vector<AffineStep> steps;

  /// Features (d x n) -> inputs (k x n).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& features) const;

  /// M (k x d) of apply(x) = M x + apply(0); needs a step, which knows d.
  Eigen::MatrixXd calcMatrix() const;

  /// Whether no step mixes features, so that M is diagonal; and its diagonal then.
  bool isDiagonal() const;
  Eigen::VectorXd calcScale() const;

  /// Covariance of features (d x d) -> of inputs (k x k).
  NoiseCovariance applyToCovariance(const NoiseCovariance& covariance) const;
};

/// Fits the steps to training samples (n >= 2), one after another: a step sees what those before it made of
/// features, noise covariance and sensitivities. What each kind of step is, its errors and its cost stand at
/// its own function: fitZScore, fitWhiten (affine_step.hpp), fitPrincipalComponents,
/// fitPartialLeastSquares, fitSelect (selections.hpp).
FeatureTransform fitTransform(const std::vector<TransformStepSpec>& steps, const LabelledFeatures& samples);

}  // namespace twinmap
