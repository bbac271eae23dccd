#pragma once

#include "framework/experiment/measurement_spec.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// That columns are given for outputs of the model, in units that convert to the outputs' (the time's to s).
/// Throws ExperimentError.
void checkMeasurement(const MeasurementSpec& measurement, const ModelSpec& model);

}  // namespace twinmap
