#pragma once

#include "framework/spec/experiment_spec.hpp"

namespace twinmap {

/// Fills in the defaults that depend on other values: axes of the report, transform, sample_time of
/// correlated noise, prominence of peaks, replicates of the noise.
void resolveDefaults(ExperimentSpec& experiment);

}  // namespace twinmap
