#pragma once

#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap::experiment_design {

/// How large one signal of the excitation is over the simulation.
struct SignalMeasure {
  double max_abs = 0.0;   ///< in its unit
  double max_rate = 0.0;  ///< its unit per s; a jump counts as taking a two thousandth of the simulation
  double rms = 0.0;       ///< over the whole simulation
  double crest_factor() const { return rms > 0.0 ? max_abs / rms : 0.0; }
};

/// Of every signal, at the centre of the bounds; before t = 0 signals are 0. Between two events (jumps
/// and bends) a signal is sampled at 9 points or more, 2000 in the whole simulation, and its square
/// integrated by Simpson's rule. Throws SimulationFailure for numbers that no signal can have.
std::vector<SignalMeasure> calcSignalMeasures(const ModelSpec& model);

}  // namespace twinmap::experiment_design
