#include "framework/cli/waiting_line.hpp"

#include <chrono>
#include <iostream>

#include "framework/cli/progress_line.hpp"

namespace twinmap::cli {

WaitingLine::WaitingLine(std::string what) : what_(std::move(what)) {
  if (isTerminal()) {
    thread_ = std::thread([this] { renew(); });
  }
}

void WaitingLine::describe(std::string what) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
}

void WaitingLine::renew() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kPatience(2);
  constexpr std::chrono::milliseconds kInterval(500);
  const Clock::time_point start = Clock::now();
  std::unique_lock lock(mutex_);
  woken_.wait_for(lock, kPatience, [this] { return over_; });
  while (!over_) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    std::cerr << kClearLine << what_ << ", " << describeDuration(seconds) << std::flush;
    shown_ = true;
    woken_.wait_for(lock, kInterval, [this] { return over_; });
  }
}

void WaitingLine::clear() {
  if (!thread_.joinable()) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  woken_.notify_one();
  thread_.join();
  if (shown_) {
    std::cerr << kClearLine << std::flush;
  }
}

}  // namespace twinmap::cli
