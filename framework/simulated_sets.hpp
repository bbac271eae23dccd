#pragma once

#include "framework/experiment.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {

struct SimulatedSets {
  Trajectories train, test;
};

/// Simulates both sets of an experiment and writes samples.h5 and failures.csv; failures and times go to the
/// summary. `simulator` must know the experiment's outputs at the features' times. Throws std::runtime_error
/// if more samples failed than simulation.allowed_failures permits.
SimulatedSets simulateSets(const ExperimentSpec& experiment, const Simulator& simulator,
                           const RunOptions& options, RunSummary& run);

/// Indices of the samples that could be simulated.
std::vector<int> findSuccessful(const Trajectories& trajectories);

}  // namespace twinmap
