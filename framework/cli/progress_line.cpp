#include "framework/cli/progress_line.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <string_view>

#include "framework/base/log/search_stage.hpp"

namespace twinmap::cli {
bool isTerminal() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

std::size_t getTerminalWidth() {
  constexpr std::size_t kUnknown = 80;
  winsize size{};
  if (!isTerminal()) {
    return 0;
  }
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUnknown;
}

void writeToStderr(const std::string& text) {
  std::cerr << text << std::flush;
}

ProgressLine::ProgressLine(bool is_quiet)
    : terminal_(isTerminal()), line_(getTerminalWidth(), &writeToStderr) {
  if (!is_quiet) {
    thread_ = std::thread([this] { watch(); });
  }
}

ProgressLine::~ProgressLine() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    woken_.notify_one();
    thread_.join();
  }
}

void ProgressLine::watch() {
  constexpr std::chrono::milliseconds kInterval(100);
  std::unique_lock lock(mutex_);
  while (!woken_.wait_for(lock, kInterval, [this] { return over_; })) {
    line_.tick(std::chrono::duration<double>(Clock::now() - begun_).count());
  }
}

void ProgressLine::startStage(const Progress& progress) {
  first_ = progress;
  start_ = shown_ = Clock::now();
}

bool ProgressLine::isDue(const Progress& progress) const {
  constexpr double kTerminalSeconds = 0.1, kOtherSeconds = 5.0;
  const std::chrono::duration<double> waited = Clock::now() - shown_;
  const bool last = terminal_ && progress.done == progress.total;
  return last || waited.count() >= (terminal_ ? kTerminalSeconds : kOtherSeconds);
}

std::string ProgressLine::makeBar(const Progress& progress) const {
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * progress.work);
  return "[" + std::string(filled, '#') + std::string(kWidth - filled, '-') + "] ";
}

std::string ProgressLine::describe(const Progress& progress) const {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  std::string text = fmt::format("{}: {} of {}", progress.stage, progress.done, progress.total);
  if (progress.simulates && seconds > 0.0) {
    text += fmt::format(", {:.0f} simulations/s", (progress.done - first_.done) / seconds);
  }
  if (progress.failed > 0) {
    text += fmt::format(", {} failed", progress.failed);
  }
  const double worked = progress.work - first_.work;
  if (worked > 0.0) {
    text += ", " + describeDuration(seconds * (1.0 - progress.work) / worked) + " left";
  }
  return text;
}

void ProgressLine::update(const Progress& progress) {
  const std::lock_guard lock(mutex_);
  if (progress.stage != first_.stage) {
    startStage(progress);
  }
  if (!isDue(progress)) {
    return;
  }
  shown_ = Clock::now();
  line_.note(std::chrono::duration<double>(shown_ - begun_).count());
  if (terminal_) {
    std::cerr << kClearLine << makeBar(progress) << describe(progress) << std::flush;
  } else {
    std::cerr << "twinmap: " << describe(progress) << std::endl;
  }
}

void ProgressLine::clear() {
  const std::lock_guard lock(mutex_);
  if (terminal_) {
    std::cerr << kClearLine << std::flush;
  }
}

}  // namespace twinmap::cli
