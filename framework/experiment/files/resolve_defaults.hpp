#pragma once

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Fills in the defaults that depend on other values: axes of the report, transform, sample_time of
/// correlated noise, rounding by sensors, prominence of peaks, an automatic number of training samples,
/// replicates of the noise where that number is known.
void resolveDefaults(ExperimentSpec& experiment);

/// A resolved experiment with so many training samples instead of an automatic number of them, and the
/// defaults that follow.
ExperimentSpec takeTrainingSamples(ExperimentSpec experiment, int samples);

}  // namespace twinmap
