#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// A Markdown table, columns aligned so that it reads well as plain text: the first `text_columns` to the
/// left, numbers to the right. The first row is the header; cells are escaped already.
std::string makeAlignedTable(const std::vector<std::vector<std::string>>& rows, std::size_t text_columns);

}  // namespace twinmap
