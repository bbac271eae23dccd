#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/features/labelled_features.hpp"
#include "framework/spec/experiment_spec.hpp"

namespace twinmap {

/// x -> P (x - offset) / scale, the division element by element; without P where it is empty.
struct AffineStep {
  Eigen::VectorXd offset;      ///< d
  Eigen::VectorXd scale;       ///< d, > 0
  Eigen::MatrixXd projection;  ///< P, k x d, or empty

  /// d x n -> k x n (or d x n).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& features) const;

  /// Differences of features (d x n) -> differences of inputs: P x / scale.
  Eigen::MatrixXd applyLinear(const Eigen::MatrixXd& differences) const;

  /// Covariance of features (d x d) -> of inputs (k x k).
  Eigen::MatrixXd applyToCovariance(const Eigen::MatrixXd& covariance) const;
};

/// From features to the inputs of the inverse map: affine steps one after another. Fitted once, on the
/// training features, then a plain value.
struct FeatureTransform {
  std::vector<AffineStep> steps;

  /// Features (d x n) -> inputs (k x n).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& features) const;
};

/// Fits the steps to training samples (n >= 2), one after another: a step sees what those before it made of
/// features, noise covariance and sensitivities.
/// - z_score: offset is the mean, scale the standard deviation (1/(n-1)); a constant feature has scale 1, so
///   that it says nothing instead of NaN.
/// - whiten: scale is the noise's standard deviation, which must be above 0.
/// - principal_components: eigenvectors of the sample covariance (1/(n-1)), largest first, each with its
///   largest loading positive. By default those whose eigenvalue stands above the Marchenko-Pastur edge
///   (1 + sqrt(d / n))^2, the largest of unit noise alone; at least one is kept.
///
/// Cost: min(d, n)^3 + d n min(d, n) flops for principal components. Throws std::invalid_argument where noise
/// is 0 or more components are asked for than there are.
FeatureTransform fitTransform(const std::vector<TransformStepSpec>& steps, const LabelledFeatures& samples);

}  // namespace twinmap
