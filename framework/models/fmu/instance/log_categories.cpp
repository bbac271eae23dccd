#include "framework/models/fmu/instance/log_categories.hpp"

#include <algorithm>
#include <cctype>

namespace twinmap::fmi {

bool isErrorCategory(const std::string& name) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* word : {"error", "fatal", "discard", "warning"}) {
    if (lower.find(word) != std::string::npos) {
      return true;
    }
  }
  return false;
}

std::string toFileUri(const std::filesystem::path& path) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const unsigned char c : path.string()) {
    if (std::isalnum(c) != 0 || std::string("-._~/").find(static_cast<char>(c)) != std::string::npos) {
      uri += static_cast<char>(c);
    } else {
      uri += {'%', kDigits[c / 16], kDigits[c % 16]};
    }
  }
  return uri;
}

}  // namespace twinmap::fmi
