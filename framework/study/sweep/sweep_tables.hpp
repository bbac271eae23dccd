#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/experiment/files/sweep_cases.hpp"

namespace twinmap {

/// Writes sweep.csv (a row for each case and parameter: case, the swept keys, the columns of metrics.csv),
/// summary.csv (mean and standard error over the seeds for every combination of the other keys) and table.md
/// from the metrics.csv of the complete cases, in the order of the cases. Returns the text of table.md.
/// Throws std::runtime_error if a metrics.csv is damaged.
std::string writeSweepTables(const std::filesystem::path& folder, const std::vector<std::string>& keys,
                             const std::vector<SweepCase>& cases, const std::vector<bool>& complete);

}  // namespace twinmap
