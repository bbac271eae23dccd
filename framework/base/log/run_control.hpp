#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>

namespace twinmap {

/// A run that was asked to stop (RunControl::stop): what was finished has been written.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How far a stage of a run is.
struct Progress {
  std::string stage;  ///< "simulate", "cases"
  int done = 0;       ///< samples or cases, failed ones included
  int total = 0;
  int failed = 0;
  double work = 0.0;       ///< fraction of the stage's work that is done; cases differ in size
  bool simulates = false;  ///< done counts simulations
};

/// Called from any thread, one call at a time.
using ProgressCallback = std::function<void(const Progress&)>;

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
