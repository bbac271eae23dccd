#include "framework/models/fmu/instance/message_log.hpp"

#include <algorithm>
#include <cctype>

namespace twinmap::fmi {

void MessageLog::add(const std::string& status, const std::string& message) {
  constexpr std::size_t kMaxMessages = 5, kMaxCharacters = 400;  // a reason that people read
  std::string line = message.substr(0, kMaxCharacters);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  line.erase(line.find_last_not_of(' ') + 1);
  if (line.empty()) {
    return;
  }
  messages_.push_back(line + " (" + status + ")");
  if (messages_.size() > kMaxMessages) {
    messages_.pop_front();
  }
}

std::string MessageLog::describe() const {
  std::string text;
  for (const std::string& message : messages_) {
    text += (text.empty() ? "; the FMU says: " : "; ") + message;
  }
  return text;
}

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
