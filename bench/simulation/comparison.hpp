#pragma once

#include <string>

#include "bench/simulation/lane_profile.hpp"
#include "bench/simulation/mechanism.hpp"

namespace twinmap::bench {

/// What was found for one mechanism; errors are the largest deviation from a tight solution, over twelve
/// parameter sets and all output times, in parts of each output's range; times in us a sample.
struct Comparison {
  std::string name;
  int directions = 0;  ///< parameters
  double mujoco_error = 0.0, lane_error = 0.0, simbody_error = 0.0;
  double mujoco_step = 0.0;        ///< s
  double fine_mujoco_error = 0.0;  ///< with a quarter of that step
  double mujoco_time = 0.0, lane_time = 0.0, simbody_time = 0.0;
  double derivative_time = 0.0;  ///< values with the derivatives with respect to all parameters, in lanes
  LaneProfile profile;

  /// MuJoCo's time at the error of the lanes: its steps come in whole numbers, so that it errs a little less.
  /// By the method's order, error ~ step^4.
  double calcMujocoTimeAtEqualError() const;
};

/// Simulates by MuJoCo's Runge-Kutta method with the largest step whose error is not above that of the lanes,
/// in lanes and by Simbody, one thread, in `rounds` rounds in alternation; processor time. Throws
/// std::runtime_error where MuJoCo simulates another mechanism: where no step reaches that error, or a
/// quarter of it does not all but remove what is left.
Comparison compare(const Mechanism& mechanism, int rounds);

}  // namespace twinmap::bench
