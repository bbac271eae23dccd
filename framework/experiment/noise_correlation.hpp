#pragma once

#include <Eigen/Core>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// The autocorrelation of correlated noise at lags 0 .. lags; an autoregression must be stationary.
Eigen::VectorXd calcAutocorrelation(const NoiseCorrelationSpec& spec, Eigen::Index lags);

/// Fills in the sample_time of correlated noise: the spacing of its output's feature times. Not where they
/// are not equidistant; checkNoise then asks for it.
void resolveNoiseCorrelation(ExperimentSpec& experiment);

}  // namespace twinmap
