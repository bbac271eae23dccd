#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/features/feature_block.hpp"

namespace twinmap {

/// Features of samples whose parameters are known, one column a sample; several draws of the noise
/// (replicates) stand draw by draw.
struct LabelledFeatures {
  std::vector<FeatureInfo> infos;    ///< d
  Eigen::MatrixXd features;          ///< d x n, noisy
  Eigen::MatrixXd parameters;        ///< p x n
  Eigen::MatrixXd noise_covariance;  ///< d x d, of the features; where it differs among samples, its mean
  int replicates = 1;
  /// Sensitivities of the features to the parameters (d x p each) at some points of the box, in features per
  /// width of the parameters' bounds; only where a selection by information needs them.
  std::vector<Eigen::MatrixXd> sensitivities;
};

}  // namespace twinmap
