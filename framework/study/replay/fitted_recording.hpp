#pragma once

#include <optional>
#include <string>

#include "framework/inference/inferrer.hpp"
#include "framework/report/recording_figures.hpp"

namespace twinmap {

/// A measurement beside the model at the point that explains it best, at its recorded times and with its
/// excitation; noise of unknown size is that which was found. known: q; id: of the figures. None where
/// nothing explains it or can be simulated there, of reduced samples, of what has no times, and where the
/// recorder's clock is not the model's. Throws MeasurementError. Cost: a simulation.
std::optional<ShownRecording> fitRecording(const MeasurementReader& reader, const Table& table,
                                           std::optional<double> start, const Eigen::VectorXd& known,
                                           const InferredMeasurement& inferred, const std::string& id);

}  // namespace twinmap
