#pragma once

#include <atomic>

#include "framework/monitoring/progress.hpp"

namespace twinmap {

/// What every stage of a run obeys and reports to.
struct RunControl {
  int threads = 1;  ///< results do not depend on it
  /// Once true, the simulations under way are finished and kept, a training under way is abandoned; where
  /// something is missing then, Interrupted is thrown.
  const std::atomic<bool>* stop = nullptr;
  ProgressCallback progress = nullptr;
};

}  // namespace twinmap
