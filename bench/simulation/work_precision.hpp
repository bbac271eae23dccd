#pragma once

#include <string>
#include <vector>

namespace twinmap::bench {

struct Mechanism;

/// A setting of a method: what it costs and how far it is from the solution.
struct WorkPrecision {
  double setting = 0.0;  ///< relative tolerance, or step in s
  double error = 0.0;    ///< parts of each output's range, the largest
  double time = 0.0;     ///< us a sample, one thread, processor time
};

/// Both curves of a mechanism.
struct WorkPrecisionCurves {
  std::string mechanism;
  std::vector<WorkPrecision> lanes, mujoco;
};

/// Simulates in lanes at tolerances from 3e-2 to 1e-12, as the simulation stage of a run does
/// (generateSamples), and by MuJoCo's Runge-Kutta method with steps that become shorter until its error is
/// below 1e-10; medians of `rounds` rounds in alternation. Throws std::runtime_error where MuJoCo simulates
/// another mechanism: where its error does not fall below 1e-10.
WorkPrecisionCurves measureCurves(const Mechanism& mechanism, int rounds);

}  // namespace twinmap::bench
