#pragma once

#include <filesystem>
#include <vector>

#include "framework/base/log/stage_notes.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/study.hpp"

namespace twinmap {

/// The simulated training and test samples of an experiment.
struct SimulatedSets {
  Trajectories train, test;
  int reused = 0;  ///< samples that the source had already
  StageNotes notes{};
};

/// Simulates what the source does not have of both sets of a study, which has one. Throws Interrupted if it
/// is stopped while samples are missing.
SimulatedSets simulateSets(const Study& study);

/// The failed samples of both sets.
std::vector<FailedSample> listFailures(const SimulatedSets& sets);

/// Throws std::runtime_error if more samples of a set failed than simulation.allowed_failures permits, or all
/// but one; the message names the first, and `file` that lists them all.
void requireFewFailures(const ExperimentSpec& experiment, const std::vector<FailedSample>& failures,
                        const std::filesystem::path& file);

/// Indices of the samples that did not fail.
std::vector<int> findSuccessful(const Trajectories& trajectories);

}  // namespace twinmap
