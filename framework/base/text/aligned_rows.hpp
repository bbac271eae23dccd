#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// Rows of cells as lines of text, for a terminal: columns as wide as their longest cell and two spaces
/// apart, the first `left` aligned to the left, the others to the right; no spaces at the ends of lines. Each
/// line begins with `indent`. Requires rows, each with as many cells.
std::string alignRows(const std::vector<std::vector<std::string>>& rows, std::size_t left,
                      const std::string& indent = "");

}  // namespace twinmap
