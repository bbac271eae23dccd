#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "framework/inference/clock/recorded_samples.hpp"
#include "framework/inference/clock_fault.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap {

/// A measurement whose clock has faults.
struct ClockedMeasurement {
  std::shared_ptr<const SimulatorRefiner> simulator;  ///< the faults' sizes behind the model's unknown
  Eigen::VectorXd features;                           ///< NaN also where they cannot be simulated
  SampledMeasurement sampled;
  std::vector<ClockFault> faults;
};

/// The faults of a recorder's clock that explain a measurement which the stated noise does not: a delay, a
/// rate, both, or slips (as many as one in twenty samples, at most 40, each with odds of a thousand to one
/// against chance anywhere), the fewest first. By least squares from `best`, of all unknown parameters, on;
/// then sampled with the parameters, so that intervals follow. None where none leaves noise, or the sizes are
/// not significant. One clock for all outputs. Cost: some 10 simulators made, each linearised once, for each
/// fault; and a posterior where one is found.
std::optional<ClockedMeasurement> findClockFaults(const RecordedSamples& recorded,
                                                  const Eigen::VectorXd& best,
                                                  const SimulatorPosteriorOptions& options);

}  // namespace twinmap
