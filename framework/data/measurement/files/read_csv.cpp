#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "framework/data/measurement/files/csv_cells.hpp"
#include "framework/data/measurement/files/csv_layout.hpp"
#include "framework/data/measurement/files/csv_lines.hpp"
#include "framework/data/measurement/files/table_builder.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"
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
    if (parseTimeStamp(cell, value)) {
      return nullptr;
    }
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

  struct Line {
    std::string text;
    std::size_t number;
  };

  bool nextContent(std::string_view& line) {
    while (lines_.next(line)) {
      const std::string_view content = trimBlanks(line);
      if (!content.empty() && content.front() != '#') {
        number_ = lines_.getNumber();
        return true;
      }
    }
    return false;
  }

  /// The next line that is neither empty nor a comment, of those that were looked at first.
  bool nextLine(std::string_view& line) {
    if (next_looked_at_ == looked_at_.size()) {
      return nextContent(line);
    }
    line = looked_at_[next_looked_at_].text;
    number_ = looked_at_[next_looked_at_].number;
    ++next_looked_at_;
    return true;
  }

  /// Leaves out what stands above the header.
  CsvLayout lookAhead() {
    constexpr std::size_t kLines = 200;
    std::string_view line;
    std::vector<std::string> texts;
    while (looked_at_.size() < kLines && nextContent(line)) {
      looked_at_.push_back({std::string(line), number_});
      texts.emplace_back(line);
    }
    if (texts.empty()) {
      throw MeasurementError(source_ + ": has no line; must have one that names the columns");
    }
    const CsvLayout layout = findCsvLayout(texts);
    next_looked_at_ = layout.header;
    return layout;
  }

  void readHeader() {
    std::string_view line, cell;
    const CsvLayout layout = lookAhead();
    nextLine(line);
    separator_ = layout.separator;
    bool has_name = false;
    double number = 0.0;
    for (CsvCells cells(line, separator_); cells.next(cell);) {
      has_name = has_name || (!cell.empty() && !isCsvNumber(cell) && parseNumber(cell, number) != nullptr);
    }
    for (CsvCells cells(line, separator_); has_name && cells.next(cell);) {
      addColumn(cell);
    }
    if (!has_name) {
      numberColumns();
      return;
    }
    if (layout.has_units && nextLine(line)) {
      readUnits(line);
    }
  }

  /// Of a table without a line of names: "1", "2", ..., and that line is the first row.
  void numberColumns() {
    std::string_view cell;
    --next_looked_at_;
    std::size_t number = 0;
    for (CsvCells cells(looked_at_[next_looked_at_].text, separator_); cells.next(cell);) {
      addColumn(std::to_string(++number));
    }
  }

  /// Units below the names, perhaps in brackets; those in the header go before them.
  void readUnits(std::string_view line) {
    std::string_view cell;
    std::size_t column = 0;
    for (CsvCells cells(line, separator_); cells.next(cell) && column < columns_.size(); ++column) {
      const bool in_brackets = cell.size() > 2 && ((cell.front() == '[' && cell.back() == ']') ||
                                                   (cell.front() == '(' && cell.back() == ')'));
      const std::string_view unit = in_brackets ? cell.substr(1, cell.size() - 2) : cell;
      std::optional<std::string>& known = columns_[column].header.unit;
      if (!known && !unit.empty() && unit != "-") {
        known = std::string(unit);
      }
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
    } else if (const char* problem = parse(cell, value)) {
      skip(cells, cell, problem);
      return;
    }
    table_.reserve(1);
    cells.values.push_back(value);
  }

  /// A number with the decimal sign of the whole table: the first that a number has.
  const char* parse(std::string_view cell, double& value) {
    const std::size_t sign = separator_ == ',' ? std::string_view::npos : cell.find_first_of(".,");
    if (sign == std::string_view::npos || parseTimeStamp(cell, value)) {
      return parseNumber(cell, value);
    }
    if (decimal_ == 0 && isCsvNumber(cell)) {
      decimal_ = cell[sign];
    }
    if (decimal_ != ',') {
      const bool is_other = decimal_ == '.' && cell.find(',') != std::string_view::npos;
      return is_other ? "must be a number with a decimal point, as those before" : parseNumber(cell, value);
    }
    if (cell.find('.') != std::string_view::npos) {
      return "must be a number with a decimal comma, as those before";
    }
    number_text_.assign(cell);
    std::replace(number_text_.begin(), number_text_.end(), ',', '.');
    return parseNumber(number_text_, value);
  }

  void skip(Cells& cells, std::string_view cell, const char* problem) {
    constexpr std::size_t kShown = 40;
    const std::string quoted =
        "'" + std::string(cell.substr(0, kShown)) + (cell.size() > kShown ? "..." : "") + "' ";
    cells.kept = false;
    cells.values = {};
    table_.skip(cells.header.name, (cell.empty() ? "" : "has " + quoted + "which ") + std::string(problem),
                number_);
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
    throw MeasurementError(source_ + ":" + std::to_string(number_) + ": " + problem);
  }

  CsvLines lines_;
  const std::string& source_;
  TableBuilder table_;
  const MissingCells missing_;
  std::vector<Line> looked_at_;  // content lines that were read to find the header
  std::size_t next_looked_at_ = 0, number_ = 0;
  char separator_ = ',';
  char decimal_ = 0;  // 0: not known yet
  std::string number_text_;
  std::vector<Cells> columns_;
};

}  // namespace

Table readCsv(std::istream& stream, const std::string& source, const std::vector<std::string>& wanted,
              MissingCells missing) {
  return CsvReader(stream, source, wanted, missing).read();
}

}  // namespace twinmap
