#pragma once

#include <string>
#include <vector>

#include "bench/simulation/lane_profile.hpp"

namespace twinmap::bench {

/// What was found for one mechanism; errors in parts of each output's range, times in us a sample.
struct Comparison {
  std::string name;
  int directions = 0;  ///< parameters
  double mujoco_error = 0.0, lane_error = 0.0, simbody_error = 0.0;
  double mujoco_step = 0.0;        ///< s
  double fine_mujoco_error = 0.0;  ///< with a quarter of that step
  double mujoco_time = 0.0, lane_time = 0.0, simbody_time = 0.0;
  double derivative_time = 0.0;  ///< values with the derivatives with respect to all parameters, in lanes
  LaneProfile profile;
};

/// Markdown tables.
void printComparisons(const std::vector<Comparison>& comparisons);
void printLanes(const std::vector<Comparison>& comparisons);
void printPrograms(const std::vector<Comparison>& comparisons, const ProgramCost& multiply_adds,
                   const ProgramCost& sines);

}  // namespace twinmap::bench
