#pragma once

#include <chrono>
#include <string>

#include "framework/base/log/progress.hpp"

namespace twinmap::cli {

/// Returns to the beginning of a terminal's line and empties it.
constexpr const char* kClearLine = "\r\x1b[K";

/// "1:02:03", "0:42".
std::string describeDuration(double seconds);

/// Shows progress on stderr: on a terminal one line with a bar, renewed ten times a second; elsewhere a line
/// every five seconds.
class ProgressLine {
 public:
  ProgressLine();

  void update(const Progress& progress);
  /// Removes the line from the terminal.
  void clear() const;

 private:
  using Clock = std::chrono::steady_clock;

  void startStage(const Progress& progress);
  bool isDue(const Progress& progress) const;
  std::string describe(const Progress& progress) const;
  std::string makeBar(const Progress& progress) const;

  bool terminal_;
  Progress first_;  ///< of the stage
  Clock::time_point start_, shown_;
};

/// Whether stderr is a terminal that understands control sequences.
bool isTerminal();

}  // namespace twinmap::cli
