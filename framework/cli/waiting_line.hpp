#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "framework/base/log/search_line.hpp"
#include "framework/base/log/search_stage.hpp"

namespace twinmap::cli {

/// Says on stderr what a command is at (SearchLine), as long as it lives, and ends the process at SIGINT or
/// SIGTERM with what is known then: how far it is, the best fit and its parameters.
class WaitingLine {
 public:
  /// at_interrupt: prints what is finished and waits for the rest; called by a thread of its own.
  explicit WaitingLine(std::string what, std::function<void()> at_interrupt = {});
  ~WaitingLine() { clear(); }
  WaitingLine(const WaitingLine&) = delete;
  WaitingLine& operator=(const WaitingLine&) = delete;

  /// What it is busy with from now on. at_interrupt: in the place of the one before.
  void describe(std::string what, std::function<void()> at_interrupt);
  /// Ends it; before anything else is printed.
  void clear();

 private:
  void renew();

  std::function<void()> at_interrupt_;
  std::optional<SearchStage> stage_;
  SearchLine line_;
  std::mutex mutex_;
  std::condition_variable woken_;
  bool over_ = false;
  std::thread thread_;
};

/// A window of a file, as its line of progress names it.
std::string nameWindow(const std::string& file, const std::optional<double>& start);

}  // namespace twinmap::cli
