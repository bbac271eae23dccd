#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// How late a change is announced: of lives in which one of several constants steps, or begins to move by a
/// slope, after 30 measurements. Sizes are in standard deviations of one measurement, a slope's per
/// measurement. Numbers of measurements, the first with the change included; NaN where so many lives are not
/// announced within 100.
struct AlarmDelay {
  bool is_slope = false;
  double size = 0.0;
  double median = 0.0, upper = 0.0;  ///< 95 %
  double found = 0.0;                ///< share of the lives
};

/// 20 lives of each size: every run has them. Cost: some 0.03 s a parameter.
std::vector<AlarmDelay> calcAlarmDelays(Eigen::Index parameters, double false_alarms, std::uint64_t seed);

/// track_power.csv (docs/reference/files.md): calcAlarmDelays() at one false alarm in 1000, in the units of
/// each parameter by the estimates of a run's test samples. Standard deviations are those of a measurement
/// given all other parameters, which are as they were, at the median of the samples. Sizes beyond the width
/// of the bounds are left out.
std::string makeTrackPowerCsv(const std::vector<ParameterSpec>& parameters, const Estimates& tests,
                              std::uint64_t seed);

}  // namespace twinmap
