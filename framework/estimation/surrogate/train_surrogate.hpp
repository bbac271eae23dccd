#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/data/features/noise_covariance.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"
#include "framework/estimation/surrogate/surrogate_samples.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

struct ForwardChoices;
struct ForwardSamples;
struct HeldOut;
struct Surrogate;
struct SurrogateSamples;
struct TrainingControl;

/// What a surrogate's errors owe to the number of its simulations.
struct SimulationGain {
  Eigen::Index half = 0, all = 0;  ///< simulations compared; 0 where they are too few to be halved
  Eigen::VectorXd error_ratio;     ///< p: errors with all over those with half; empty likewise
};

/// Trains once more on the first half of the simulations, from the choices made for all, and compares the
/// mean absolute errors of inferences from measured features of the second half (at most 200) with those that
/// the cross-validation found for the same: of four fifths of the simulations, 1.6 times the half, from which
/// those of all follow by a power law. Cost: less than a fold of the cross-validation.
SimulationGain calcSimulationGain(const Surrogate& whole, const SurrogateSamples& samples,
                                  const ForwardSamples& forward, const ForwardChoices& choices,
                                  const HeldOut& held_out, const TrainingControl& control);

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
