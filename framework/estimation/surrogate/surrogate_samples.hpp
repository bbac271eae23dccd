#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/data/features/noise_covariance.hpp"

namespace twinmap {

/// Simulations to train a surrogate on.
struct SurrogateSamples {
  std::vector<FeatureInfo> infos;    ///< d
  Eigen::MatrixXd points;            ///< m x n: updating, nuisance, known inputs, in their units
  Eigen::MatrixXd clean_features;    ///< d x n
  NoiseCovariance noise_covariance;  ///< d x d
  Eigen::MatrixXd measured;          ///< d x n draws, with noise: column j + i n is draw i of simulation j
  /// n, or none: derivatives of the clean features (d x u) with respect to the unknowns, the first u
  /// variables, per width of their bounds; empty where a simulation has none.
  std::vector<Eigen::MatrixXd> slopes{};
};

}  // namespace twinmap
