#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/data/features/noise_covariance.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/trained/trust_model.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What a trust model is fitted to.
struct TrustTraining {
  std::vector<ParameterSpec> sampled;  ///< the box: unknown parameters, then known inputs
  BoxPrior prior;                      ///< of those that a measurement leaves open
  std::vector<FeatureInfo> infos;      ///< d
  Eigen::MatrixXd points;              ///< m x n, of the training simulations
  Eigen::MatrixXd clean_features;      ///< d x n
  NoiseCovariance noise_covariance;    ///< d x d, of the features
  Eigen::MatrixXd measured;            ///< d x s, simulated measurements, other than the training's
  Eigen::MatrixXd known;               ///< q x s, their known inputs
  std::uint64_t seed = 0;              ///< of the noise that refined answers are compared with
};

/// Fits the reference distributions of a surrogate that was fitted to the training simulations, or to the
/// first of them: judges every simulated measurement as if it were one. The surrogate must not have seen
/// their simulations. Throws std::invalid_argument for a feature without noise, and where there are no
/// simulated measurements. The result does not depend on the threads. Cost: that of s inferences. Throws
/// gp::Stopped.
TrustModel fitTrustModel(const TrustTraining& training, std::shared_ptr<const ForwardSurrogate> surrogate,
                         const Estimator& map, double level, const TrainingControl& control);

}  // namespace twinmap
