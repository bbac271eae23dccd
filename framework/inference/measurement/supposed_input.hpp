#pragma once

#include <memory>
#include <optional>

#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// The experiment with the likeliest excitation of a measurement, of which not all is known
/// (hasUnknownExcitation). With n of unit variance in G n, the response to excitation e + n is
/// f(e + m) + G (n - m) about the likeliest m. found: G m is added, and G is what its rows have in common (of
/// outputs of unknown noise in units of that). None, and found as it was, where all of the excitation is
/// known or nothing can be simulated. Three times a fit of the parameters, then of the excitation. Cost:
/// three posteriors of few draws, three times calcUnknownResponses().
std::optional<ExperimentSpec> supposeInput(const MeasurementReader& reader, AvailableFeatures& found,
                                           const Eigen::VectorXd& known, SimulatorPosteriorOptions options);

/// The simulator of a measurement that states noise of its own, or of its excitation (supposeInput). Null
/// where that of the reader's experiment will do.
std::unique_ptr<const SimulatorRefiner> makeOwnSimulator(const MeasurementReader& reader,
                                                         const SimulatorRefiner& usual,
                                                         AvailableFeatures& found,
                                                         const Eigen::VectorXd& known,
                                                         const SimulatorPosteriorOptions& options);

}  // namespace twinmap
