#pragma once

#include <Eigen/Core>

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

}  // namespace twinmap
