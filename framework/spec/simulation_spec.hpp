#pragma once

namespace twinmap {

enum class Integrator { kDopri5, kRungeKuttaMerson, kCpodes };

struct SimulationSpec {
  double duration = 0.0;  ///< s; above 0 where features are made of outputs
  Integrator integrator = Integrator::kDopri5;
  double relative_tolerance = 3e-7;  ///< local error per step, relative to the state
  double absolute_tolerance = 1e-9;  ///< and absolute, in the state's own units
  int max_steps = 100000;            ///< per sample; more is reported as a failure
  double max_wall_time = 60.0;       ///< s per sample; more is reported as a failure
  double allowed_failures = 0.05;    ///< fraction of a set's samples that may fail before the run does
};

}  // namespace twinmap
