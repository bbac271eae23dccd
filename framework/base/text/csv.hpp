#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace twinmap {

using CsvRow = std::vector<std::string>;

/// A CSV file (RFC 4180) with a header: cells as texts, looked up by the name of their column.
struct CsvTable {
  CsvRow columns;
  std::vector<CsvRow> rows;  ///< each as long as `columns`

  bool empty() const { return rows.empty(); }
  /// -1 if there is no such column.
  int findColumn(const std::string& column) const;
  bool hasColumn(const std::string& column) const { return findColumn(column) >= 0; }
  /// "" if there is no such column.
  const std::string& getText(std::size_t row, const std::string& column) const;
  /// NaN if there is no such column, or no number in the cell.
  double getNumber(std::size_t row, const std::string& column) const;
  /// The cells of a column.
  std::vector<std::string> listTexts(const std::string& column) const;
  std::vector<double> listNumbers(const std::string& column) const;
  /// Of some rows.
  std::vector<double> listNumbers(const std::string& column, const std::vector<std::size_t>& of_rows) const;
  /// Rows whose cell of a column is `text`.
  std::vector<std::size_t> findRows(const std::string& column, const std::string& text) const;
  /// The different texts of a column, in the order of their first rows.
  std::vector<std::string> listDistinct(const std::string& column) const;
};

/// Lines of cells separated by commas, escaped by RFC 4180.
std::string makeCsv(const std::vector<CsvRow>& rows);
/// A table that was read, as a text again.
std::string makeCsv(const CsvTable& table);

/// Parses a CSV text; `what` names it in errors. Throws std::runtime_error naming the line whose cells do not
/// fit the header, or in which a quote is not closed.
CsvTable parseCsv(const std::string& text, const std::string& what);

/// Reads a CSV file; a table without columns if there is no such file.
CsvTable readCsvFile(const std::filesystem::path& path);

/// The whole text of a file; "" if there is no such file.
std::string readTextFile(const std::filesystem::path& path);

}  // namespace twinmap
