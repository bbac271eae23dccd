#pragma once

#include <atomic>

#include "framework/base/log/interrupted.hpp"
#include "framework/base/log/progress.hpp"

namespace twinmap {

/// What every stage of a run obeys and reports to.
struct RunControl {
  int threads = 1;  ///< results do not depend on it
  /// Once true, the simulations and cases under way are finished and kept, and no other is begun; where
  /// something is missing then, Interrupted is thrown.
  const std::atomic<bool>* stop = nullptr;
  /// Once true, a training under way is not finished either; Interrupted is thrown.
  const std::atomic<bool>* abandon = nullptr;
  ProgressCallback progress = nullptr;
};

/// Throws Interrupted, with `message`, once the run is abandoned: before a stage that takes a moment, or in
/// its loop.
inline void throwIfCancelled(const RunControl& control,
                             const char* message = "interrupted; what was simulated is kept") {
  if (control.abandon != nullptr && *control.abandon) {
    throw Interrupted(message);
  }
}

}  // namespace twinmap
