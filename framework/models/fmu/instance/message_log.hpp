#pragma once

#include <deque>
#include <filesystem>
#include <string>

namespace twinmap::fmi {

/// The last messages that an FMU has logged since clear(): what a failed call adds to its reason.
class MessageLog {
 public:
  /// `status`: of the message, as a word of the standard. Line ends become spaces; what is long is cut.
  void add(const std::string& status, const std::string& message);
  void clear() { messages_.clear(); }

  /// "; the FMU says: stiffness is negative (Error)", or "".
  std::string describe() const;

 private:
  std::deque<std::string> messages_;
};

/// Whether a log category's name says that it is about what went wrong: "logStatusError", "logStatusFatal",
/// "logStatusDiscard", "logStatusWarning" of the standard and their like. The others may be a message a call.
bool isErrorCategory(const std::string& name);

/// "file:///tmp/a%20b/resources" (RFC 3986).
std::string toFileUri(const std::filesystem::path& path);

}  // namespace twinmap::fmi
