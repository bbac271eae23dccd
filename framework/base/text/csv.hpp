#pragma once

#include <string>
#include <vector>

#include "framework/base/text/csv_file.hpp"

namespace twinmap {

using CsvRow = std::vector<std::string>;

/// Lines of cells separated by commas, escaped by RFC 4180.
std::string makeCsv(const std::vector<CsvRow>& rows);
/// A table that was read, as a text again.
std::string makeCsv(const CsvTable& table);

}  // namespace twinmap
