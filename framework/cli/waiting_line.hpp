#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace twinmap::cli {

/// Says on a terminal (stderr) what a command is busy with, and for how long, once it takes longer than two
/// seconds: a line that is renewed twice a second and removed at the end. Nothing elsewhere, and no thread.
class WaitingLine {
 public:
  explicit WaitingLine(std::string what);
  ~WaitingLine() { clear(); }
  WaitingLine(const WaitingLine&) = delete;
  WaitingLine& operator=(const WaitingLine&) = delete;

  /// What it is busy with from now on.
  void describe(std::string what);
  /// Ends it; before anything else is printed.
  void clear();

 private:
  void renew();

  std::mutex mutex_;
  std::condition_variable woken_;
  std::string what_;
  bool over_ = false, shown_ = false;
  std::thread thread_;
};

}  // namespace twinmap::cli
