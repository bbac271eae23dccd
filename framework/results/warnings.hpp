#pragma once

#include <string>
#include <vector>

#include "framework/results/run_summary.hpp"

namespace twinmap {

/// What a person should know before relying on a run, the most severe first, each told once for all
/// parameters that it concerns: what its stages noted, then what follows from its results: samples that
/// failed, intervals that hold too few or too many true values, answers far above the information limit,
/// parameters that the response says little of or does not tell apart, searches that ended at a bound,
/// parameters for which more simulations would not help.
std::vector<std::string> collectWarnings(const RunSummary& run);

}  // namespace twinmap
