#pragma once

#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// Which of a sensor's faults a recording is taken with: a colour is not among them, as little terms of a
/// model look alike.
enum class SensorFaults { kSizes, kSizesAndOffsets };

/// Takes a recording as inference explains it alone: samples that are no noise are left out, and sizes of
/// noise that were found stand for those stated or unknown; offsets are integrated out, if they are asked
/// for.
void takeFaults(const SimulatorFit& fit, SensorFaults faults, std::size_t recording,
                RecordedFeatures& recordings);

}  // namespace twinmap
