#pragma once

#include <string>

namespace twinmap {

/// The text without the blanks and line ends around it.
inline std::string trim(const std::string& text) {
  constexpr const char* kBlanks = " \t\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace twinmap
