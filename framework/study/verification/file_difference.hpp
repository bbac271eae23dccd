#pragma once

#include <filesystem>
#include <string>

namespace twinmap {

/// Where a CSV text differs from the one that it should be: "line 4, stddev: 0.1 instead of 0.2", or the
/// number of rows, the columns, or bytes outside of the cells. Wall times (columns seconds_...) may differ.
/// Empty if nothing does.
std::string findCsvDifference(const std::string& text, const std::string& expected);

/// The same of any text, by lines.
std::string findTextDifference(const std::string& text, const std::string& expected);

/// The same of files, each by its kind (.h5, .csv, other): the first difference and its place. Throws
/// std::runtime_error if `file` is not there or cannot be read.
std::string findFileDifference(const std::filesystem::path& file, const std::filesystem::path& expected);

}  // namespace twinmap
