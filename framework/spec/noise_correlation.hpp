#pragma once

#include "framework/spec/experiment_spec.hpp"

namespace twinmap {

/// Fills in the sample_time of correlated noise: the spacing of its output's feature times. Not where they
/// are not equidistant; checkNoiseCorrelation then asks for it.
void resolveNoiseCorrelation(ExperimentSpec& experiment);

/// Checks the correlation of the noise: outputs exist, the feature times of each lie on a grid of
/// sample_time, an autoregression is stationary and given values are an autocorrelation. Throws
/// ExperimentError.
void checkNoiseCorrelation(const ExperimentSpec& experiment);

/// Times in units of `sample_time` after the first, rounded; empty where one is not on that grid.
std::vector<long> findGrid(const std::vector<double>& times, double sample_time);

}  // namespace twinmap
