#pragma once

#include <spdlog/formatter.h>
#include <spdlog/sinks/sink.h>

#include <filesystem>
#include <memory>
#include <string>

namespace twinmap {

/// A spdlog formatter whose pattern may use %* for the LogContext of the thread.
std::unique_ptr<spdlog::formatter> makeLogFormatter(const std::string& pattern);

/// As long as it lives, the log goes to `folder`/run.log as well, with date, level and LogContext; appended
/// to what an earlier run of the folder has logged. To be made and destroyed while no other thread logs.
class RunLog {
 public:
  explicit RunLog(const std::filesystem::path& folder);
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;
  ~RunLog();

 private:
  spdlog::sink_ptr sink_;
};

}  // namespace twinmap
