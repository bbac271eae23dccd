#pragma once

#include <optional>

#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/simulator_sampler.hpp"

namespace twinmap {

/// A measurement whose excitation is not all known, about what its response says of that: with n of unit
/// variance in G n, the response to excitation e + n is f(e + m) + G (n - m) about the likeliest m.
struct SupposedInput {
  ExperimentSpec experiment;  ///< with the likeliest excitation
  Eigen::MatrixXd common;     ///< G, rows x r, of outputs of unknown noise in units of that (StatedNoise)
  Eigen::VectorXd offset;     ///< G m, rows: what the measured response is more than one to compare it with
};

/// Three times a fit of the parameters, then of the excitation. None where all of the excitation is known or
/// nothing can be simulated. Cost: three posteriors of few draws, three times calcUnknownResponses().
std::optional<SupposedInput> supposeInput(const MeasurementReader& reader, const AvailableFeatures& found,
                                          const Eigen::VectorXd& known, SimulatorPosteriorOptions options);

}  // namespace twinmap
