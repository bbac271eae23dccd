#pragma once

#include <functional>
#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/models/mechanism/lanes/recording/recorded_sensor.hpp"
#include "framework/models/mechanism/system_names.hpp"
#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap {

/// Something that happens at k period + sign delay, k = 0, 1 ..., within the simulation: then a phase begins
/// in which the phase input `input` is 1 + k mod `slots`; in all others it is 0.
struct RecordedClock {
  double period;  ///< s
  int delay;      ///< its place in RecordedSampling::delays; -1: none
  double sign;    ///< of the delay
  int input, slots;
};

/// Sensors and sampled controllers, written down. Both have states that no expression sees ("hidden"), behind
/// all others: a sensor's own; what a controller has computed and not yet written, what it has taken of a
/// sensor's past and not yet read, and what its differences were of. They change where a phase begins: at the
/// start, where sensors settle; where a controller writes, takes and reads, in this order.
struct RecordedSampling {
  using Symbols = std::vector<program::Symbol>;

  Symbols hidden_rates;
  Symbols outputs;                 ///< those of the model; then what is subtracted from them
  std::vector<int> subtracted;     ///< of each output of the model its place in `outputs`; -1: nothing
  std::vector<int> output_delays;  ///< of all `outputs` in `delays`; -1: none. Empty: none at all
  Symbols delays;                  ///< s; of parameters alone; outputs' first
  int output_delay_count = 0;
  Symbols jumps;  ///< all states behind a jump; empty: there are none
  std::vector<lanes::Passed> passed;
  std::vector<RecordedClock> clocks;
  int start_input = -1;  ///< the phase input that is 1 in the first phase alone; -1: nothing settles
  int input_count = 0;   ///< phase inputs, with those before
};

/// What is sampled.
struct SampledModel {
  const ModelSpec& model;
  const SystemNames& names;
  const NamedValues<program::Symbol>& numbers;  ///< parameters and constants
  program::Recorder& recorder;
  std::vector<program::Symbol> states;       ///< all but the hidden ones
  std::vector<program::Symbol> coordinates;  ///< as prescribed, where they are
  std::vector<program::Symbol> signals;
  int input_count;  ///< phase inputs of the excitation
  /// The outputs' quantities as the states of first order say; the others are as they are.
  std::function<std::vector<program::Symbol>(const std::vector<program::Symbol>&)> calcQuantities;

  int getFirstOrderPlace() const { return 2 * static_cast<int>(names.getCoordinateNames().size()); }
};

}  // namespace twinmap
