#pragma once

#include <memory>

#include "framework/experiment/run_experiment.hpp"
#include "framework/sampling/sample_source.hpp"
#include "framework/sampling/simulate_missing.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// The stage that simulates neighbourhoods (NeighbourhoodSimulator), for people.
inline constexpr const char* kNeighbourhoodStage = "simulate sensitivities";

struct SimulatedSets {
  Trajectories train, test;
};

/// Warns of chunks that could not be used.
void logSetAside(const TrajectoryStore& store);

/// Of a run's stage that simulates; `simulations` are behind each sample that is reported.
MissingOptions makeMissingOptions(const std::string& stage, int simulations, const RunOptions& options);

/// Opens the store of a model's samples in the folder `root`. Chunks that had to be set aside are logged.
std::unique_ptr<TrajectoryStore> openStore(const ModelSpec& model, const ResponseLayout& layout,
                                           const std::filesystem::path& root);

/// Simulates what the source does not have of both sets of an experiment, and writes samples.h5; times go to
/// the summary. `layout` is that of the experiment's own features. Throws Interrupted if the options ask to
/// stop while samples are missing.
SimulatedSets simulateSets(const ExperimentSpec& experiment, const SampleSource& source,
                           const ResponseLayout& layout, const RunOptions& options, RunSummary& run);

/// Writes failures.csv and keeps the failures in the summary. Throws std::runtime_error if more samples
/// failed than simulation.allowed_failures permits.
void recordFailures(const ExperimentSpec& experiment, const SimulatedSets& sets, const RunOptions& options,
                    RunSummary& run);

/// Indices of the samples that did not fail.
std::vector<int> findSuccessful(const Trajectories& trajectories);

}  // namespace twinmap
