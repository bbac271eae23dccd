#pragma once

#include <string>

#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// The values beyond the bounds that leave at most a hundredth of a gross misfit, in a sentence; else "".
/// Asked where that ends at its bounds. Searched within bounds four times as far; a bound of 0 is that
/// of a sign, and stays. Cost: four searches.
std::string explainByBounds(const MeasurementReader& reader, const SimulatorRefiner& simulator,
                            const AvailableFeatures& found, const Eigen::VectorXd& known,
                            const SimulatorFit& fit);

}  // namespace twinmap
