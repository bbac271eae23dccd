#pragma once

#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/bounded_draws.hpp"
#include "framework/estimation/ridges/identified_combinations.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The marginal Fisher information about the updating parameters (p x p each, per width of their bounds) at
/// points of the sampled box (columns); empty where a simulation fails. Throws std::invalid_argument for a
/// feature without noise. Cost: a simulation with derivatives, or 2 u + 1 simulations, a point.
std::vector<Eigen::MatrixXd> calcInformation(const Simulator& simulator, const FeatureExtractor& extractor,
                                             const FeatureNoise& noise, const ModelSpec& model,
                                             const Eigen::MatrixXd& points, int threads);

/// Whether draws of a posterior under a uniform prior are spread so far that there may be ridges (mayBeFlat).
/// The first rows of the draws are `parameters`. Without simulations.
bool mayHaveRidges(const BoundedDraws& draws, const std::vector<ParameterSpec>& parameters);

/// Ridges as the simulator shows them at points of the sampled box that all fit one measurement, best first.
/// At most 32 of them are taken.
std::vector<Ridge> simulateRidges(const Simulator& simulator, const FeatureExtractor& extractor,
                                  const FeatureNoise& noise, const ModelSpec& model,
                                  const Eigen::MatrixXd& points, int threads);

}  // namespace twinmap
