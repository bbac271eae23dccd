#include "framework/data/measurement/files/csv_layout.hpp"

#include <algorithm>
#include <charconv>

#include "framework/data/measurement/files/csv_cells.hpp"

namespace twinmap {
namespace {

struct CellCount {
  std::size_t cells = 0, numbers = 0, names = 0;  ///< names: neither numbers nor empty
  bool last_is_empty = false;

  /// An empty cell at the end, after a last separator, counts or not.
  bool isAsLongAs(const CellCount& other) const {
    return cells - (last_is_empty ? 1 : 0) == other.cells - (other.last_is_empty ? 1 : 0);
  }
};

CellCount countCells(const std::string& line, char separator) {
  CellCount count;
  std::string_view cell;
  for (CsvCells cells(line, separator); cells.next(cell); ++count.cells) {
    const bool is_number = isCsvNumber(cell);
    count.numbers += is_number ? 1 : 0;
    count.names += !is_number && !cell.empty() ? 1 : 0;
    count.last_is_empty = cell.empty();
  }
  return count;
}

/// Numbers in as many cells as the header has.
bool isData(const std::string& line, char separator, const CellCount& header) {
  const CellCount count = countCells(line, separator);
  return count.isAsLongAs(header) && count.numbers > 0;
}

char findSeparatorOf(const std::vector<std::string>& lines, std::size_t header) {
  constexpr char kBlanks = ' ';
  const std::string& line = lines[header];
  const char separator = findSeparator(line);
  if (line.find(separator) != std::string::npos || header + 1 == lines.size()) {
    return separator;
  }
  const CellCount names = countCells(line, kBlanks);
  return names.cells > 1 && countCells(lines[header + 1], kBlanks).cells == names.cells ? kBlanks : separator;
}

/// The layout if that line names the columns and numbers follow; else `found` is false.
CsvLayout tryHeader(const std::vector<std::string>& lines, std::size_t header, bool& found) {
  CsvLayout layout{header, false, findSeparatorOf(lines, header)};
  const CellCount names = countCells(lines[header], layout.separator);
  const auto has_data = [&](std::size_t line) {
    return line < lines.size() && isData(lines[line], layout.separator, names);
  };
  const bool named = names.cells > 1 && names.names > 0 && names.numbers == 0;
  if (named && !has_data(header + 1) && has_data(header + 2)) {
    const CellCount units = countCells(lines[header + 1], layout.separator);
    layout.has_units = units.isAsLongAs(names) && units.names > 0 && units.numbers == 0;
  }
  found = named && (has_data(header + 1) || layout.has_units);
  return layout;
}

}  // namespace

bool isCsvNumber(std::string_view cell) {
  std::string text(cell.substr(!cell.empty() && cell.front() == '+' ? 1 : 0));
  std::replace(text.begin(), text.end(), ',', '.');
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

CsvLayout findCsvLayout(const std::vector<std::string>& lines) {
  bool found = false;
  const CsvLayout first = tryHeader(lines, 0, found);
  const bool is_table =
      lines.size() < 2 || isData(lines[1], first.separator, countCells(lines[0], first.separator));
  if (found || is_table) {
    return first;
  }
  for (std::size_t header = 1; header < lines.size(); ++header) {
    const CsvLayout layout = tryHeader(lines, header, found);
    if (found) {
      return layout;
    }
  }
  return first;
}

}  // namespace twinmap
