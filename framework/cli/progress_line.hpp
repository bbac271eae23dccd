#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "framework/base/log/run_control.hpp"
#include "framework/base/log/search_line.hpp"

namespace twinmap::cli {

/// Shows progress on stderr: on a terminal one line with a bar, renewed ten times a second; elsewhere a line
/// every five seconds. A stage that reports none is named as often (SearchLine).
class ProgressLine {
 public:
  /// is_quiet: shows nothing.
  explicit ProgressLine(bool is_quiet = false);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(const Progress& progress);
  /// Removes the line from the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void watch();
  void startStage(const Progress& progress);
  bool isDue(const Progress& progress) const;
  std::string describe(const Progress& progress) const;
  std::string makeBar(const Progress& progress) const;

  bool terminal_;
  Progress first_;  ///< of the stage
  Clock::time_point start_, shown_;
  const Clock::time_point begun_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable woken_;
  bool over_ = false;
  SearchLine line_;  ///< of stages without progress of their own
  std::thread thread_;
};

/// Whether stderr is a terminal that understands control sequences.
bool isTerminal();
/// In columns; 0 where there is none.
std::size_t getTerminalWidth();
void writeToStderr(const std::string& text);

}  // namespace twinmap::cli
