#pragma once

#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// What of a sensor's noise is taken from inference, and what is left to be found by a test of the model.
struct TakenFaults {
  bool offsets = false;        ///< else they compete with other terms
  bool unstated_sizes = true;  ///< else those that the experiment does not state are not taken
  bool colours = false;        ///< else they may be what the model lacks
};

/// Takes a recording as inference explains it alone. Samples that are no noise are left out, and sizes of
/// noise that were found stand for those stated. Offsets are integrated out.
void takeFaults(const SimulatorFit& fit, const TakenFaults& taken, std::size_t recording,
                RecordedFeatures& recordings);

/// The same of those among several that it explains; of the others only samples are left out.
void takeFaults(const std::vector<RecordingInference>& alone, const TakenFaults& taken,
                RecordedFeatures& recordings);

/// Recordings as inference explains each alone, for a diagnosis.
struct DiagnosedRecordings {
  RecordedFeatures features, coloured;  ///< without and with the colours of the noise
  std::vector<RecordingInference> alone;
};

/// An offset of one recording alone competes with other terms; of several each has its own. Throws as
/// readRecordings().
DiagnosedRecordings explainSensors(const JointInferrer& inferrer, const ExperimentSpec& experiment,
                                   const std::vector<Recording>& recordings,
                                   const std::vector<KnownValue>& known);

}  // namespace twinmap
