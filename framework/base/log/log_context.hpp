#pragma once

#include <string>

namespace twinmap {

/// Names what the calling thread works on, a case of a sweep, in the log, as long as it lives.
class LogContext {
 public:
  explicit LogContext(std::string name);
  LogContext(const LogContext&) = delete;
  LogContext& operator=(const LogContext&) = delete;
  ~LogContext();

  /// "NAME: " on this thread, or "".
  static const std::string& getPrefix();
};

}  // namespace twinmap
