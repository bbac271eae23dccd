#include "framework/base/text/text_tables.hpp"

#include <algorithm>

namespace twinmap {
namespace {

using Row = std::vector<std::string>;

std::vector<std::size_t> findWidths(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  return widths;
}

/// The cells, each as wide as its column.
Row padRow(const Row& cells, const std::vector<std::size_t>& widths, std::size_t text_columns) {
  Row padded;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string padding(widths[i] - cells[i].size(), ' ');
    padded.push_back(i < text_columns ? cells[i] + padding : padding + cells[i]);
  }
  return padded;
}

std::string joinRow(const Row& cells, const std::string& separator) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += (i == 0 ? "" : separator) + cells[i];
  }
  return line;
}

}  // namespace

std::string alignRows(const std::vector<Row>& rows, std::size_t text_columns, const std::string& indent) {
  const std::vector<std::size_t> widths = findWidths(rows);
  std::string text;
  for (const Row& row : rows) {
    std::string line = indent + joinRow(padRow(row, widths, text_columns), "  ");
    text += line.erase(line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string makeMarkdownRows(const std::vector<Row>& rows, std::size_t text_columns) {
  const std::vector<std::size_t> widths = findWidths(rows);
  std::string text;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    text += "| " + joinRow(padRow(rows[row], widths, text_columns), " | ") + " |\n";
    for (std::size_t i = 0; row == 0 && i < widths.size(); ++i) {
      const bool is_text = i < text_columns;
      text += "|" + std::string(widths[i] + (is_text ? 2 : 1), '-') + (is_text ? "" : ":");
    }
    text += row == 0 ? "|\n" : "";
  }
  return text;
}

std::string makeLatexRows(const std::vector<Row>& rows, std::size_t text_columns) {
  std::string text = "\\begin{tabular}{" + std::string(text_columns, 'l') +
                     std::string(rows[0].size() - text_columns, 'r') + "}\n\\toprule\n";
  for (std::size_t row = 0; row < rows.size(); ++row) {
    text += joinRow(rows[row], " & ") + " \\\\\n" + (row == 0 ? "\\midrule\n" : "");
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace twinmap
