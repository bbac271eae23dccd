#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/features/feature_block.hpp"
#include "framework/online/trust_model.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// What a trust model is fitted to.
struct TrustTraining {
  std::vector<ParameterSpec> sampled;  ///< the box: unknown parameters, then known inputs
  Eigen::Index unknown = 0;            ///< how many a measurement leaves open
  std::vector<FeatureInfo> infos;      ///< d
  Eigen::MatrixXd points;              ///< m x n, of the training simulations
  Eigen::MatrixXd clean_features;      ///< d x n
  Eigen::MatrixXd noise_covariance;    ///< d x d, of the features
  Eigen::MatrixXd measured;            ///< d x s, simulated measurements, other than the training's
  Eigen::MatrixXd known;               ///< q x s, their known inputs
};

/// Fits the forward model and its reference distributions: judges every simulated measurement as if it were
/// one. Throws std::invalid_argument as fitForwardModel() does, and where there are no simulated
/// measurements. Cost: that of fitForwardModel() and of s inferences.
TrustModel fitTrustModel(const TrustTraining& training, const OnlineMap& map, double level);

}  // namespace twinmap
