#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace twinmap {

/// A CSV file (RFC 4180) with a header: cells as texts, looked up by the name of their column.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`

  bool empty() const { return rows.empty(); }
  /// -1 if there is no such column.
  int findColumn(const std::string& column) const;
  bool hasColumn(const std::string& column) const { return findColumn(column) >= 0; }
  /// "" if there is no such column.
  const std::string& getText(std::size_t row, const std::string& column) const;
  /// NaN if there is no such column, or no number in the cell.
  double getNumber(std::size_t row, const std::string& column) const;
};

/// Parses a CSV text; `what` names it in errors. Throws std::runtime_error naming the line whose cells do not
/// fit the header, or in which a quote is not closed.
CsvTable parseCsv(const std::string& text, const std::string& what);

/// Reads a CSV file; a table without columns if there is no such file.
CsvTable readCsvFile(const std::filesystem::path& path);

/// The whole text of a file; "" if there is no such file.
std::string readTextFile(const std::filesystem::path& path);

}  // namespace twinmap
