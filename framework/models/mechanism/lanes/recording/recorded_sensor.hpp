#pragma once

#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/sensor_spec.hpp"
#include "kernels/lanes/program/symbol.hpp"

namespace twinmap {

/// What a sensor adds to the equations: states of its own, and a reading now(t - delay) - before(t - delay -
/// window), which is then clipped and rounded.
///   lag         y' = (x - y) / lag
///   Butterworth of order n: y'' = w^2 (x - y) - 2 sin((2 k - 1) pi / 2 n) w y' for k = 1 ... n / 2, one
///   after
///               the other, and y' = w (x - y) where n is odd; w = 2 pi cutoff
///   average     c + J(t) - J(t - window) with J' = (x - c) / window: c is x as it was at the start, so that
///               J is 0 there and before
struct RecordedSensor {
  using Symbols = std::vector<program::Symbol>;

  Symbols rates;    ///< of its states
  Symbols settled;  ///< its states at the start
  program::Symbol now, before;
  program::Symbol delay, window;  ///< s; the literal 0 where there is none
};

int countSensorStates(const SensorSpec& sensor);

/// `names`: parameters and constants; `quantity`: what the sensor measures; `states`: its own.
RecordedSensor recordSensor(const SensorSpec& sensor, const NamedValues<program::Symbol>& names,
                            const program::Symbol& quantity, const std::vector<program::Symbol>& states);

/// The reading clipped.
program::Symbol clip(const SensorSpec& sensor, const program::Symbol& reading);

}  // namespace twinmap
