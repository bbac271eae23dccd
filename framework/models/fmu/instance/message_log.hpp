#pragma once

#include <deque>
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

}  // namespace twinmap::fmi
