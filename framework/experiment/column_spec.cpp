#include "framework/experiment/column_spec.hpp"

#include "framework/base/text/trim.hpp"

namespace twinmap {

ColumnSpec parseColumn(const std::string& text, const SourceLocation& where) {
  const std::string trimmed = trim(text);
  const std::size_t open = trimmed.rfind('[');
  if (open == std::string::npos || trimmed.back() != ']') {
    return {trimmed, {}, where};
  }
  return {trim(trimmed.substr(0, open)), trim(trimmed.substr(open + 1, trimmed.size() - open - 2)), where};
}

std::string toText(const ColumnSpec& column) {
  return column.name + (column.unit ? " [" + *column.unit + "]" : "");
}

}  // namespace twinmap
