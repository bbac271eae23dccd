#pragma once

#include <Eigen/Core>

#include "framework/data/features/noise_covariance.hpp"
#include "framework/data/reduction/affine_step.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Offset is the mean, scale the standard deviation (1/(n-1)) of the features (d x n, n >= 2); a constant
/// feature has scale 1, so that it says nothing instead of NaN.
AffineStep fitZScore(const Eigen::MatrixXd& features);

/// Makes noise of covariance C (d x d) unit noise. By stddev: scale is the noise's standard deviation. By
/// covariance: W with W C W' = 1 (NoiseWhitener), which is the same where the noise is independent. Throws
/// std::invalid_argument for a feature without noise.
AffineStep fitWhiten(const WhitenSpec& spec, const NoiseCovariance& noise_covariance);

}  // namespace twinmap
