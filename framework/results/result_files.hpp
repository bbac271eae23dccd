#pragma once

#include <filesystem>

#include "framework/results/run_summary.hpp"
#include "framework/store/provenance.hpp"

namespace twinmap {

/// Writes the tables of what a run found: metrics, predictions, training, evaluation.
void writeResults(const std::filesystem::path& folder, const RunSummary& run);

/// Writes provenance.json, from what `provenance` says of the start of the run (command, seed, threads), what
/// the run found and the digests of the files that are there.
void writeProvenance(const std::filesystem::path& folder, Provenance provenance, const RunSummary& run);

}  // namespace twinmap
