#include "framework/cli/waiting_line.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "framework/base/text/number_text.hpp"
#include "framework/cli/progress_line.hpp"
#include "framework/cli/signals.hpp"

namespace twinmap::cli {
namespace {

/// Without a return: the threads that search know of no end before theirs.
[[noreturn]] void endByInterrupt(double seconds) {
  const SearchState state = getSearchState();
  const std::string best = describeBest(state);
  std::cerr << fmt::format("twinmap: interrupted after {}: {}\n", describeDuration(seconds),
                           describeState(state));
  if (!best.empty()) {
    std::cerr << (state.best->stddevs.empty() ? "  best so far, of a search that has not ended: "
                                              : "  best fit, with the standard deviations drawn about it: ")
              << best << "\n";
  }
  std::cerr.flush();
  std::cout.flush();
  std::_Exit(128 + getSignal());
}

}  // namespace

WaitingLine::WaitingLine(std::string what, std::function<void()> at_interrupt)
    : at_interrupt_(std::move(at_interrupt)),
      stage_(std::in_place, std::move(what)),
      line_(getTerminalWidth(), &writeToStderr) {
  watchInterrupt(true);
  thread_ = std::thread([this] { renew(); });
}

void WaitingLine::describe(std::string what, std::function<void()> at_interrupt) {
  const std::lock_guard lock(mutex_);
  at_interrupt_ = std::move(at_interrupt);
  stage_.reset();
  stage_.emplace(std::move(what));
}

void WaitingLine::renew() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kInterval(100);
  const Clock::time_point start = Clock::now();
  std::unique_lock lock(mutex_);
  while (!woken_.wait_for(lock, kInterval, [this] { return over_; })) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (getSignal() != 0) {
      line_.clear();
      if (at_interrupt_) {
        at_interrupt_();
      }
      endByInterrupt(seconds);
    }
    line_.tick(seconds);
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
  watchInterrupt(false);
  line_.clear();
  stage_.reset();
}

std::string nameWindow(const std::string& file, const std::optional<double>& start) {
  return start ? fmt::format("{} from {} s", file, toText(*start)) : file;
}

}  // namespace twinmap::cli
