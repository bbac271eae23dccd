#pragma once

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Checks the noise against outputs and features: every output has its noise, outputs exist, modes have
/// noise where they are features. Of correlated noise: the feature times of its output lie on a grid of
/// sample_time, an autoregression is stationary and given values are an autocorrelation. Throws
/// ExperimentError.
void checkNoise(const ExperimentSpec& experiment);

}  // namespace twinmap
