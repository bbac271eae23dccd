#pragma once

#include <string>

#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// Whether masses of a thousandth, given in g, explain a misfit; "" where not. Cost: that of
/// findLeastChiSquare() for each body whose mass is a number, and once more for all of several.
std::string explainByGrams(const MeasurementReader& reader, const SimulatorRefiner& simulator,
                           const AvailableFeatures& found, const Eigen::VectorXd& known,
                           const SimulatorFit& fit);

}  // namespace twinmap
