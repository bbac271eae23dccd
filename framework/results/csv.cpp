#include "framework/results/csv.hpp"

#include "framework/results/escape.hpp"

namespace twinmap {

std::string makeCsv(const std::vector<CsvRow>& rows) {
  std::string text;
  for (const CsvRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i == 0 ? "" : ",") + escapeCsv(row[i]);
    }
    text += "\n";
  }
  return text;
}

std::string makeCsv(const CsvTable& table) {
  return makeCsv(std::vector<CsvRow>{table.columns}) + makeCsv(table.rows);
}

}  // namespace twinmap
