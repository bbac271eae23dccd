#pragma once

#include <string>
#include <vector>

namespace twinmap {

// Rows of cells as text; each has as many cells as the first. The first `text_columns` are aligned to the
// left, numbers to the right.

/// Lines for a terminal: columns as wide as their longest cell and two spaces apart; no spaces at the ends of
/// lines. Each line begins with `indent`.
std::string alignRows(const std::vector<std::vector<std::string>>& rows, std::size_t text_columns,
                      const std::string& indent = "");

/// A Markdown table, columns aligned so that it reads well as plain text. The first row is the header; cells
/// are escaped already.
std::string makeMarkdownRows(const std::vector<std::vector<std::string>>& rows, std::size_t text_columns);

/// The same as a LaTeX table (booktabs).
std::string makeLatexRows(const std::vector<std::vector<std::string>>& rows, std::size_t text_columns);

}  // namespace twinmap
