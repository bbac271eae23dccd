#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace spdlog::sinks {
class sink;
}

namespace twinmap {

/// One line of the log each. From any thread.
void logInfo(const std::string& text);
void logWarning(const std::string& text);
void logError(const std::string& text);

/// The log goes to stderr from now on, each line after `before` and "twinmap: ", in colour if that is wanted
/// and stderr is a terminal; and to run logs. To be called, as what follows, while no other thread logs.
void logToStderr(const std::string& before, bool in_colour);

/// Only warnings and errors go to stderr from now on; run logs have all.
void showWarningsOnly();

/// The log goes to run logs alone from now on.
void logToRunsOnly();

/// Nothing is logged from now on, not even to run logs.
void silenceLog();

/// As long as it lives, the log goes to `folder`/run.log as well, with date, level and LogContext; appended
/// to what an earlier run of the folder has logged. To be made and destroyed while no other thread logs.
class RunLog {
 public:
  explicit RunLog(const std::filesystem::path& folder);
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;
  ~RunLog();

 private:
  std::shared_ptr<spdlog::sinks::sink> sink_;
};

}  // namespace twinmap
