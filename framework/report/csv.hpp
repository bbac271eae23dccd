#pragma once

#include <string>
#include <vector>

namespace twinmap {

using CsvRow = std::vector<std::string>;

/// Lines of cells separated by commas, escaped by RFC 4180.
std::string makeCsv(const std::vector<CsvRow>& rows);

}  // namespace twinmap
