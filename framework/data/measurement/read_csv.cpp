#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "framework/data/measurement/csv_cells.hpp"
#include "framework/data/measurement/csv_lines.hpp"
#include "framework/data/measurement/table_builder.hpp"
#include "framework/experiment/column_spec.hpp"

namespace twinmap {
namespace {

/// What keeps a cell from being a finite number; nullptr if nothing does, then `value` is set.
const char* parseNumber(std::string_view cell, double& value) {
  if (cell.empty()) {
    return "has an empty cell; must be a number";
  }
  const char* first = cell.data() + (cell.front() == '+' ? 1 : 0);
  const char* last = cell.data() + cell.size();
  const auto [end, error] = std::from_chars(first, last, value);
  if (error == std::errc::result_out_of_range) {
    return "must be a number from 1e-308 to 1e308";
  }
  if (error != std::errc() || end != last) {
    return cell.find(',') == std::string_view::npos ? "must be a number"
                                                    : "must be a number with a decimal point, not a comma";
  }
  return std::isfinite(value) ? nullptr : "must be a finite number";
}

/// Whether a cell says that there is no number.
bool isMissing(std::string_view cell) {
  static constexpr std::array<std::string_view, 8> kWords{"", "nan", "na", "n/a", "null", "none", "-", "?"};
  std::string lower(cell);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

class CsvReader {
 public:
  CsvReader(std::istream& stream, const std::string& source, const std::vector<std::string>& wanted,
            MissingCells missing)
      : lines_(stream, source), source_(source), table_(source, wanted, missing), missing_(missing) {}

  Table read() {
    readHeader();
    std::string_view line;
    while (nextLine(line)) {
      readRow(line);
    }
    for (Cells& cells : columns_) {
      finish(cells);
    }
    return table_.finish();
  }

 private:
  /// A cell of the header, with the numbers below it if they are kept.
  struct Cells {
    ColumnSpec header;
    bool kept = false;
    std::vector<double> values;
  };

  bool nextLine(std::string_view& line) {
    while (lines_.next(line)) {
      const std::string_view content = trimBlanks(line);
      if (!content.empty() && content.front() != '#') {
        return true;
      }
    }
    return false;
  }

  void readHeader() {
    std::string_view line, cell;
    if (!nextLine(line)) {
      throw MeasurementError(source_ + ": has no line; must have one that names the columns");
    }
    separator_ = findSeparator(line);
    bool has_name = false;
    double number = 0.0;
    for (CsvCells cells(line, separator_); cells.next(cell);) {
      has_name = has_name || (!cell.empty() && parseNumber(cell, number) != nullptr);
      addColumn(cell);
    }
    if (!has_name) {
      fail("must name the columns, in the first line");
    }
  }

  void addColumn(std::string_view cell) {
    Cells cells{parseColumn(std::string(cell)), false, {}};
    const std::string& name = cells.header.name;
    for (const Cells& before : columns_) {
      if (!name.empty() && before.header.name == name) {
        fail("names the column '" + name + "' twice");
      }
    }
    cells.kept = !name.empty() && table_.takes(name);
    columns_.push_back(std::move(cells));
  }

  void readRow(std::string_view line) {
    std::string_view cell;
    std::size_t count = 0;
    for (CsvCells cells(line, separator_); cells.next(cell); ++count) {
      if (count < columns_.size()) {
        readCell(cell, columns_[count]);
      } else if (count > columns_.size() || !cell.empty()) {
        failCount("more cells than");
      }
    }
    const bool last_is_ignored = columns_.back().header.name.empty();
    if (count + (last_is_ignored ? 1 : 0) < columns_.size()) {
      failCount(std::to_string(count) + (count == 1 ? " cell, not as many as" : " cells, not as many as"));
    }
  }

  void readCell(std::string_view cell, Cells& cells) {
    double value = 0.0;
    if (!cells.kept) {
      return;
    }
    if (missing_ == MissingCells::kKeep && isMissing(cell)) {
      value = std::numeric_limits<double>::quiet_NaN();
    } else if (const char* problem = parseNumber(cell, value)) {
      skip(cells, cell, problem);
      return;
    }
    table_.reserve(1);
    cells.values.push_back(value);
  }

  void skip(Cells& cells, std::string_view cell, const char* problem) {
    constexpr std::size_t kShown = 40;
    const std::string quoted =
        "'" + std::string(cell.substr(0, kShown)) + (cell.size() > kShown ? "..." : "") + "' ";
    cells.kept = false;
    cells.values = {};
    table_.skip(cells.header.name, (cell.empty() ? "" : "has " + quoted + "which ") + std::string(problem),
                lines_.getNumber());
  }

  void finish(Cells& cells) {
    if (cells.kept) {
      const auto count = static_cast<Eigen::Index>(cells.values.size());
      table_.add(
          {cells.header.name, cells.header.unit, Eigen::Map<Eigen::VectorXd>(cells.values.data(), count)});
      cells.values = {};
    }
  }

  [[noreturn]] void failCount(const std::string& count) const {
    fail("has " + count + " the header, which has " + std::to_string(columns_.size()));
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw MeasurementError(source_ + ":" + std::to_string(lines_.getNumber()) + ": " + problem);
  }

  CsvLines lines_;
  const std::string& source_;
  TableBuilder table_;
  const MissingCells missing_;
  char separator_ = ',';
  std::vector<Cells> columns_;
};

}  // namespace

Table readCsv(std::istream& stream, const std::string& source, const std::vector<std::string>& wanted,
              MissingCells missing) {
  return CsvReader(stream, source, wanted, missing).read();
}

}  // namespace twinmap
