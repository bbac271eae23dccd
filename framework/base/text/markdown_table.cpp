#include "framework/base/text/markdown_table.hpp"

#include <algorithm>

namespace twinmap {
namespace {

using Row = std::vector<std::string>;

std::string padRow(const Row& cells, const std::vector<std::size_t>& widths, std::size_t text_columns) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string padding(widths[i] - cells[i].size(), ' ');
    line += " " + (i < text_columns ? cells[i] + padding : padding + cells[i]) + " |";
  }
  return line + "\n";
}

std::string makeRule(const std::vector<std::size_t>& widths, std::size_t text_columns) {
  std::string rule = "|";
  for (std::size_t i = 0; i < widths.size(); ++i) {
    rule += i < text_columns ? std::string(widths[i] + 2, '-') + "|" : std::string(widths[i] + 1, '-') + ":|";
  }
  return rule + "\n";
}

}  // namespace

std::string makeAlignedTable(const std::vector<Row>& rows, std::size_t text_columns) {
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text = padRow(rows[0], widths, text_columns) + makeRule(widths, text_columns);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    text += padRow(rows[i], widths, text_columns);
  }
  return text;
}

}  // namespace twinmap
