#include "framework/data/measurement/files/csv_cells.hpp"

#include <algorithm>

namespace twinmap {
namespace {

/// Where the quoted text that begins at line[0] ends: its closing quote, or the end of the line. Doubled
/// quotes stand for one.
std::size_t findClosingQuote(std::string_view line) {
  std::size_t close = 1;
  while (close < line.size() && (line[close] != '"' || (close + 1 < line.size() && line[close + 1] == '"'))) {
    close += line[close] == '"' ? 2 : 1;
  }
  return std::min(close, line.size());
}

}  // namespace

std::string_view trimBlanks(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && is_blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

char findSeparator(std::string_view header) {
  constexpr std::string_view kSeparators = ",;\t|";
  std::size_t counts[kSeparators.size()] = {};
  bool quoted = false;
  for (const char c : header) {
    quoted = quoted != (c == '"');
    const std::size_t index = kSeparators.find(c);
    if (!quoted && index != std::string_view::npos) {
      ++counts[index];
    }
  }
  return kSeparators[std::max_element(std::begin(counts), std::end(counts)) - std::begin(counts)];
}

CsvCells::CsvCells(std::string_view line, char separator)
    : rest_(separator == ' ' ? trimBlanks(line) : line), separator_(separator) {}

bool CsvCells::next(std::string_view& cell) {
  if (!more_) {
    return false;
  }
  const std::size_t blanks = std::min(rest_.find_first_not_of(' '), rest_.size());
  const bool quoted = blanks < rest_.size() && rest_[blanks] == '"';
  const std::size_t close = quoted ? blanks + findClosingQuote(rest_.substr(blanks)) : 0;
  const std::size_t end =
      separator_ == ' ' ? rest_.find_first_of(" \t", close) : rest_.find(separator_, close);
  cell = quoted ? rest_.substr(blanks + 1, close - blanks - 1) : rest_.substr(0, end);
  cell = trimBlanks(cell);
  more_ = end != std::string_view::npos;
  rest_.remove_prefix(more_ ? end + 1 : rest_.size());
  if (separator_ == ' ') {
    rest_ = trimBlanks(rest_);
    more_ = !rest_.empty();
  }
  return true;
}

}  // namespace twinmap
