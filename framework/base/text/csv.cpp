#include "framework/base/text/csv.hpp"

#include "framework/base/text/escape.hpp"

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
