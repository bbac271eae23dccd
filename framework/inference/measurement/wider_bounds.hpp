#pragma once

#include <string>

#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// Whether a gross misfit is that of bounds at which it ends: the values beyond them that leave at most a
/// hundredth of it, in a sentence; else "". Searched within bounds four times as far; a bound of 0 is that
/// of a sign, and stays. Cost: four searches.
std::string explainByBounds(const MeasurementReader& reader, const SimulatorRefiner& simulator,
                            const AvailableFeatures& found, const Eigen::VectorXd& known,
                            const SimulatorFit& fit);

}  // namespace twinmap
