#include "framework/experiment/column_spec.hpp"

#include "framework/base/text/trim.hpp"
#include "framework/experiment/expression/units.hpp"

namespace twinmap {

namespace {

/// Whether "Force (N)" ends in a unit; "x(t)" and "log (left)" are names.
bool holdsUnit(const std::string& text, std::size_t open) {
  return open > 0 && text[open - 1] == ' ' && isUnit(trim(text.substr(open + 1, text.size() - open - 2)));
}

}  // namespace

ColumnSpec parseColumn(const std::string& text, const SourceLocation& where) {
  const std::string trimmed = trim(text);
  const bool is_round = !trimmed.empty() && trimmed.back() == ')';
  const std::size_t open = trimmed.rfind(is_round ? '(' : '[');
  if (open == std::string::npos || (!is_round && trimmed.back() != ']')) {
    return {trimmed, {}, where};
  }
  if (is_round && !holdsUnit(trimmed, open)) {
    return {trimmed, {}, where};
  }
  return {trim(trimmed.substr(0, open)), trim(trimmed.substr(open + 1, trimmed.size() - open - 2)), where};
}

std::string toText(const ColumnSpec& column) {
  return column.name + (column.unit ? " [" + *column.unit + "]" : "");
}

}  // namespace twinmap
