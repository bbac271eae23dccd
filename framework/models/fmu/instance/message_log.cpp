#include "framework/models/fmu/instance/message_log.hpp"

#include <algorithm>

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

}  // namespace twinmap::fmi
