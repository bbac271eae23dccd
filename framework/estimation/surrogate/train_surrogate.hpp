#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/data/features/noise_covariance.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/simulation_gain.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"
#include "framework/estimation/surrogate/surrogate_samples.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// A trained surrogate and what a person should know about it.
struct SurrogateTraining {
  Surrogate surrogate;
  Estimates
      held_out;  ///< p x n draws, of measured features, by surrogates that had not seen their simulation
  Eigen::MatrixXd held_out_truth;  ///< p x n draws
  SimulationGain gain;
  int held_out_draws = 1;  ///< of each simulation: column j + i n is draw i of simulation j
  std::vector<std::string> warnings;
};

/// Why a surrogate cannot be trained on so many simulations with such noise; empty if it can.
std::string findSurrogateObstacle(const ModelSpec& model, Eigen::Index simulations,
                                  const NoiseCovariance& noise_covariance);

/// Trains a surrogate on simulations of a model, and scales its standard deviations by what a five-fold
/// cross-validation of everything, on the measured features, finds. At most the first 2000 simulations are
/// used. Throws std::invalid_argument for a feature without noise and for too few simulations; gp::Stopped.
/// Cost: fitForward() for all with five folds of four fifths; an inference for each measured column (at most
/// 1000).
SurrogateTraining trainSurrogate(const ModelSpec& model, const SurrogateSamples& samples,
                                 const TrainingControl& control);

}  // namespace twinmap
