#include "framework/cli/progress_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string_view>

namespace twinmap::cli {
bool isTerminal() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

std::string describeDuration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  constexpr long kMinute = 60, kHour = 3600;
  const std::string minutes = fmt::format("{}:{:02}", whole / kMinute, whole % kMinute);
  return whole < kHour
             ? minutes
             : fmt::format("{}:{:02}:{:02}", whole / kHour, whole % kHour / kMinute, whole % kMinute);
}

ProgressLine::ProgressLine() : terminal_(isTerminal()) {}

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
  if (progress.stage != first_.stage) {
    startStage(progress);
  }
  if (!isDue(progress)) {
    return;
  }
  shown_ = Clock::now();
  if (terminal_) {
    std::cerr << kClearLine << makeBar(progress) << describe(progress) << std::flush;
  } else {
    std::cerr << "twinmap: " << describe(progress) << std::endl;
  }
}

void ProgressLine::clear() const {
  if (terminal_) {
    std::cerr << kClearLine << std::flush;
  }
}

}  // namespace twinmap::cli
