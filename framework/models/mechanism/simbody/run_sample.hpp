#pragma once

#include <string>

#include "framework/models/mechanism/simbody/initial_state.hpp"
#include "framework/models/mechanism/simbody/outputs.hpp"
#include "framework/simulation/integration/integration.hpp"

namespace twinmap {

/// One sample to run: the system, its initial state, and where the outputs go.
struct SampleRun {
  LoadedSystem& system;
  Excitation& excitation;
  const Outputs& outputs;
  const InitialState& initial;
  const SimulationSpec& simulation;
  const Eigen::VectorXd& times;  ///< s
  double* response;              ///< outputs * times, output by output

  /// 0, the event times, and the duration.
  std::vector<double> calcBoundaries() const;
  void record(int index, double t, const SimTK::State& state) const {
    outputs.calc(system, state, t, response + index, times.size());
  }
};

/// Runs with Dormand-Prince 5(4) around calcUDot: takes the steps of `sequence`, or, if it is empty, controls
/// the error and keeps there the steps it took. Returns the reason of a failure, or "".
std::string runDopri5(const SampleRun& run, StepSequence& sequence);

/// Runs with Simbody's integrator by Runge, Kutta and Merson, which keeps loops closed, restarted at every
/// event, at accuracy `relative_tolerance`; returns the reason of a failure, or "".
std::string runSimbody(const SampleRun& run);

}  // namespace twinmap
