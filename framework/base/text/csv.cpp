#include "framework/base/text/csv.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

const std::string kNoText;

double toNumber(const std::string& text) {
  double value = 0.0;
  return parseLiteral(text, value) ? value : std::numeric_limits<double>::quiet_NaN();
}

/// Reads cells from a text, one after another.
class CellReader {
 public:
  CellReader(const std::string& text, std::string what) : text_(text), what_(std::move(what)) {}

  bool atEnd() const { return at_ >= text_.size(); }

  CsvRow readRow() {
    CsvRow cells;
    ++line_;
    do {
      cells.push_back(!atEnd() && text_[at_] == '"' ? readQuoted() : readPlain());
    } while (take(','));
    take('\r');
    if (!take('\n') && !atEnd()) {
      fail("has text after a quoted cell");
    }
    return cells;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", what_, line_, problem));
  }

 private:
  bool take(char c) {
    const bool found = !atEnd() && text_[at_] == c;
    at_ += found ? 1 : 0;
    return found;
  }

  std::string readPlain() {
    const std::size_t end = std::min(text_.find_first_of(",\r\n", at_), text_.size());
    const std::string cell = text_.substr(at_, end - at_);
    at_ = end;
    return cell;
  }

  std::string readQuoted() {
    std::string cell;
    for (++at_;; ++at_) {
      if (atEnd()) {
        fail("has a quote that is not closed");
      }
      if (take('"') && (atEnd() || text_[at_] != '"')) {
        return cell;
      }
      cell += text_[at_];
    }
  }

  const std::string& text_;
  std::string what_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace

int CsvTable::findColumn(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

const std::string& CsvTable::getText(std::size_t row, const std::string& column) const {
  const int index = findColumn(column);
  return index < 0 ? kNoText : rows[row][static_cast<std::size_t>(index)];
}

double CsvTable::getNumber(std::size_t row, const std::string& column) const {
  return toNumber(getText(row, column));
}

std::vector<std::string> CsvTable::listTexts(const std::string& column) const {
  std::vector<std::string> texts;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    texts.push_back(getText(row, column));
  }
  return texts;
}

std::vector<double> CsvTable::listNumbers(const std::string& column) const {
  std::vector<std::size_t> all(rows.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return listNumbers(column, all);
}

std::vector<double> CsvTable::listNumbers(const std::string& column,
                                          const std::vector<std::size_t>& of_rows) const {
  const int index = findColumn(column);
  std::vector<double> numbers;
  for (const std::size_t row : of_rows) {
    numbers.push_back(toNumber(index < 0 ? kNoText : rows[row][static_cast<std::size_t>(index)]));
  }
  return numbers;
}

std::vector<std::size_t> CsvTable::findRows(const std::string& column, const std::string& text) const {
  const int index = findColumn(column);
  std::vector<std::size_t> found;
  for (std::size_t row = 0; index >= 0 && row < rows.size(); ++row) {
    if (rows[row][static_cast<std::size_t>(index)] == text) {
      found.push_back(row);
    }
  }
  return found;
}

std::vector<std::string> CsvTable::listDistinct(const std::string& column) const {
  std::vector<std::string> distinct;
  for (const std::string& text : listTexts(column)) {
    if (std::find(distinct.begin(), distinct.end(), text) == distinct.end()) {
      distinct.push_back(text);
    }
  }
  return distinct;
}

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

CsvTable parseCsv(const std::string& text, const std::string& what) {
  CsvTable table;
  CellReader reader(text, what);
  if (reader.atEnd()) {
    return table;
  }
  table.columns = reader.readRow();
  while (!reader.atEnd()) {
    table.rows.push_back(reader.readRow());
    if (table.rows.back().size() != table.columns.size()) {
      reader.fail(
          fmt::format("has {} cells, but the header has {}", table.rows.back().size(), table.columns.size()));
    }
  }
  return table;
}

CsvTable readCsvFile(const std::filesystem::path& path) {
  return parseCsv(readTextFile(path), path.string());
}

std::string readTextFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return file ? text.str() : "";
}

}  // namespace twinmap
