#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

namespace twinmap {

/// The end of a time that an answer may take.
class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds), begin_(Clock::now()) {}

  bool isOver() const { return calcLeft() <= 0.0; }
  double getSeconds() const { return seconds_; }
  /// What is left of it as poll() takes it, ms.
  int calcPollTime() const {
    constexpr double kLongest = 1e9;  // ms; what an int holds
    return static_cast<int>(std::ceil(std::clamp(1000.0 * calcLeft(), 0.0, kLongest)));
  }

 private:
  using Clock = std::chrono::steady_clock;

  double calcLeft() const { return seconds_ - std::chrono::duration<double>(Clock::now() - begin_).count(); }

  double seconds_;
  Clock::time_point begin_;
};

}  // namespace twinmap
