#pragma once

#include "framework/experiment/run_experiment.hpp"

namespace twinmap {

/// Writes what a run found: tables, predictions, training, report and pictures.
void writeResults(const std::filesystem::path& folder, const RunSummary& run);

/// Writes provenance.json.
void writeProvenance(const ExperimentSpec& experiment, const RunOptions& options, const RunSummary& run);

}  // namespace twinmap
