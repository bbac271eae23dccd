#pragma once

#include <string>

#include "framework/study/replay/replay.hpp"

namespace twinmap {

// Files of a replay (docs/how-to/replay-a-measurement.md). Cells without a finite number are empty.

/// output, time, measured, nominal, updated, lower, upper, noise_stddev.
std::string makeReplayCsv(const Replay& replay);

/// t, then measured minus updated of each output: a table of measurements itself.
std::string makeResidualsCsv(const Replay& replay);

/// The fits of each output by the updated and by the nominal model; the first row names the columns.
std::vector<std::vector<std::string>> listFits(const Replay& replay);

/// The same, human-readable.
std::string makeFitTable(const Replay& replay);

}  // namespace twinmap
