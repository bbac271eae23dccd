#pragma once

#include <string>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Checks the noise against outputs and features: every output has its noise, outputs exist, modes have
/// noise where they are features. Of correlated noise: the feature times of its output lie on a grid of
/// sample_time, noise that is unknown is of samples, an autoregression is stationary and given values are an
/// autocorrelation. Throws ExperimentError.
void checkNoise(const ExperimentSpec& experiment);

/// Why features cannot be reduced as they say, a phrase of them; "" where they can, or none is to be. What is
/// reduced is weighed by its noise, and that of scores is taken to be independent.
std::string findReductionFault(const ExperimentSpec& experiment);

/// For what simulates noise or weighs information. Throws ExperimentError for noise that is unknown, which
/// inference without a run infers.
void requireStatedNoise(const ExperimentSpec& experiment);

}  // namespace twinmap
