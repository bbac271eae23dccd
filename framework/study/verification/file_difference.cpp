#include "framework/study/verification/file_difference.hpp"

#include <algorithm>
#include <sstream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/store/hdf5_difference.hpp"

namespace twinmap {
namespace {

std::string describeDifference(const std::string& place, const std::string& found,
                               const std::string& expected) {
  return place + ": '" + found + "' instead of '" + expected + "'";
}

bool isTime(const std::string& column) {
  return column.rfind("seconds_", 0) == 0;
}

std::string findCellDifference(const CsvTable& table, const CsvTable& expected) {
  for (std::size_t row = 0; row < std::min(table.rows.size(), expected.rows.size()); ++row) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      if (table.rows[row][column] != expected.rows[row][column] && !isTime(table.columns[column])) {
        return describeDifference("line " + std::to_string(row + 2) + ", " + table.columns[column],
                                  table.rows[row][column], expected.rows[row][column]);
      }
    }
  }
  return "";
}

}  // namespace

std::string findCsvDifference(const std::string& text, const std::string& expected) {
  const CsvTable table = parseCsv(text, "line"), expected_table = parseCsv(expected, "line");
  if (table.columns != expected_table.columns) {
    return findTextDifference(text, expected);
  }
  const std::string cells = findCellDifference(table, expected_table);
  if (!cells.empty()) {
    return cells;
  }
  if (table.rows.size() != expected_table.rows.size()) {
    return describeDifference("rows", std::to_string(table.rows.size()),
                              std::to_string(expected_table.rows.size()));
  }
  const bool has_times = std::any_of(table.columns.begin(), table.columns.end(), isTime);
  return text == expected || has_times ? "" : "bytes outside of the cells";
}

std::string findTextDifference(const std::string& text, const std::string& expected) {
  std::istringstream lines(text), expected_lines(expected);
  std::string line, expected_line;
  for (int number = 1;; ++number) {
    const bool more = static_cast<bool>(std::getline(lines, line));
    const bool more_expected = static_cast<bool>(std::getline(expected_lines, expected_line));
    if (!more && !more_expected) {
      return text == expected ? "" : "bytes at its end";
    }
    if (more != more_expected || line != expected_line) {
      return describeDifference("line " + std::to_string(number), more ? line : "",
                                more_expected ? expected_line : "");
    }
  }
}

std::string findFileDifference(const std::filesystem::path& file, const std::filesystem::path& expected) {
  const std::string kind = file.extension().string();
  if (kind == ".h5") {
    return findHdf5Difference(file, expected);
  }
  return kind == ".csv" ? findCsvDifference(readBytes(file), readBytes(expected))
                        : findTextDifference(readBytes(file), readBytes(expected));
}

}  // namespace twinmap
