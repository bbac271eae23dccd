#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/results/gates.hpp"

namespace twinmap {

/// A page and the data of its figures.
struct Report {
  std::string html;
  std::vector<std::pair<std::string, std::string>> data;  ///< name and CSV of each table
  std::vector<GateResult> gates;
};

/// The report of one run, of a sweep (a folder with sweep.csv), or of several runs side by side, from what
/// their folders hold and nothing else. Throws std::runtime_error for a folder without a run and for damaged
/// files.
Report makeReport(const std::vector<std::filesystem::path>& folders);

/// Writes `folder`/report.html and `folder`/figures/NAME.csv.
void writeReport(const std::filesystem::path& folder, const Report& report);

}  // namespace twinmap
