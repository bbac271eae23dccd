#pragma once

#include "framework/data/features/noise_covariance.hpp"
#include "framework/data/reduction/feature_transform.hpp"
#include "framework/estimation/network/network_map_training.hpp"
#include "framework/estimation/network/surrogate_pool.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What a network is to map to what: parameters of a model, and how.
struct NetworkTask {
  const ModelSpec& model;
  const NetworkMapSpec& spec;
  std::uint64_t seed = 0;
};

/// Simulations that a network learns from.
struct NetworkSimulations {
  const Eigen::MatrixXd& points;     ///< m x n: updating, nuisance, known inputs, in their units
  const Eigen::MatrixXd& responses;  ///< rows x n, clean
  const FeatureExtractor& extractor;
  const ResponseNoise& noise;
  const FeatureTransform& transform;        ///< from features to what the network sees, but for its scale
  bool constant_noise = true;               ///< the features' noise is normal, of noise_covariance
  const NoiseCovariance& noise_covariance;  ///< d x d
};

/// How often trainNetworkMap() trains a network on so many simulations: once, and as often again to tell how
/// calibrated it is.
int countTrainings(const NetworkMapSpec& spec, int simulations);

/// Trains a network on simulations. Networks of few simulations are overconfident: of up to 2000, ten more,
/// each of which a tenth of the simulations is left out of, tell by how much, and the standard deviations are
/// multiplied by it (calcStddevScale); of more, those held out do: a fifth, or a tenth from 20000 on. Throws
/// std::invalid_argument for fewer than 50 simulations; gp::Stopped. Cost: countTrainings() trainings.
NetworkMapTraining trainNetworkMap(const NetworkTask& task, const NetworkSimulations& simulations,
                                   const TrainingControl& control);

/// Trains a network on draws of the prior, whose scores a surrogate makes up: a normal distribution of its
/// mean, its own error and the noise. Standard deviations are multiplied by the larger of what samples held
/// out say and what the surrogate's simulations do, with the errors that it makes where each is left out.
/// Cost: a training.
NetworkMapTraining trainNetworkMap(const NetworkTask& task, const SurrogatePool& pool,
                                   const TrainingControl& control);

}  // namespace twinmap
