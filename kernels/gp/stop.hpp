#pragma once

#include <atomic>
#include <stdexcept>

namespace twinmap::gp {

/// Thrown by what was asked to stop before it was done; it leaves nothing behind.
class Stopped : public std::runtime_error {
 public:
  Stopped() : std::runtime_error("training was asked to stop") {}
};

/// Set by another thread or a signal handler; once true it must stay so. Null asks for nothing.
using StopFlag = const std::atomic<bool>*;

inline bool isStopRequested(StopFlag stop) {
  return stop != nullptr && stop->load();
}

/// Not within a parallel region, which no exception may leave.
inline void throwIfStopped(StopFlag stop) {
  if (isStopRequested(stop)) {
    throw Stopped();
  }
}

}  // namespace twinmap::gp
