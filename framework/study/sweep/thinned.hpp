#pragma once

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// An experiment with fewer of its samples in time, which a probe runs instead of it, and by what the times
/// of its stages are multiplied to be those of the whole. All 1 where the experiment is short.
struct ThinnedExperiment {
  ExperimentSpec experiment;
  double simulation = 1.0;  ///< of simulating: both were timed, each with a batch and one set of derivatives
  double rows = 1.0;        ///< of what goes through all numbers of a response (of the reduced one if any)
  double windows = 1.0;     ///< of training, for the windows of a surrogate
  double probed_reduction = 0.0;  ///< s, on one thread: finding how the fewer samples are reduced
  double reduction = 0.0;         ///< the same of the whole
  double scores = 0.0;            ///< of a window of reduced samples; 0 where they are not
};

/// Takes every k-th sample of each `samples` feature, such that some 1000 numbers of a response are left, of
/// samples that are reduced 8000: as many as all windows of a surrogate need; and of the time an eighth or
/// more, where simulating would take above 20 ms and there are no other features. Simulates a batch of the
/// whole.
ThinnedExperiment thinSamples(const ExperimentSpec& experiment);

}  // namespace twinmap
