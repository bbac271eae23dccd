#pragma once

#include <Eigen/Core>

#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap {

/// The times of a sample, s, a row each: values, then derivatives with respect to each direction.
struct SampleTimes {
  Eigen::MatrixXd events;  ///< of the excitation
  Eigen::MatrixXd delays;  ///< RecordedSampling::delays
  double origin = 0.0;     ///< of the excitation, where the integration begins
};

/// Fills in the phases, end and delays of a sample. An instant of a clock that falls on an output time but
/// for rounding is that time; behind an origin, what the excitation does at the start or the end but for
/// rounding begins no phase of its own; of times that are equal but move otherwise the earlier phases begin
/// one number before. `output_times`: increasing. Throws SimulationFailure for a delay longer than its
/// clock's slots can hold. Cost: some 100 ns a phase.
void fillPhases(const LaneModel& model, const SampleTimes& times, double duration,
                const Eigen::VectorXd& output_times, lanes::Sample& sample);

}  // namespace twinmap
