#pragma once

#include <string>

#include "framework/report/run_summary.hpp"

namespace twinmap {

/// The report of one run: a self-contained HTML page with the table, the pictures of the inferred standard
/// deviation, warnings, failures and times.
std::string makeHtmlReport(const RunSummary& run);

}  // namespace twinmap
