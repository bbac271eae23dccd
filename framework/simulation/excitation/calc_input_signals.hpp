#pragma once

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/input_signals.hpp"

namespace twinmap {

/// The excitation signals of a model at times within the simulation, for the parameters at the centre of
/// their bounds. At a time where a signal jumps it has the value after the jump, as outputs do. `times`:
/// increasing, s. Throws SimulationFailure for numbers that no signal can have.
InputSignals calcInputSignals(const ModelSpec& model, const Eigen::VectorXd& times);

}  // namespace twinmap
