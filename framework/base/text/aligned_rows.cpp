#include "framework/base/text/aligned_rows.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace twinmap {

std::string alignRows(const std::vector<std::vector<std::string>>& rows, std::size_t left,
                      const std::string& indent) {
  constexpr const char* kGap = "  ";
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i == 0 ? indent : kGap;
      line += i < left ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("{:>{}}", row[i], widths[i]);
    }
    text += line.erase(line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace twinmap
