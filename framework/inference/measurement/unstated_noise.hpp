#pragma once

#include <string>
#include <vector>

#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// What noise of a measured excitation, where none is stated, may have to do with what a fit leaves, a phrase
/// for each signal of which it is significant (once in a thousand) and that would leave nothing else.
std::vector<std::string> describeUnstatedNoise(const MeasurementReader& reader,
                                               const SimulatorRefiner& simulator,
                                               const AvailableFeatures& found, const Eigen::VectorXd& known,
                                               const PosteriorEstimate& posterior);

}  // namespace twinmap
