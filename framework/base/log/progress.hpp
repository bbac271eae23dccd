#pragma once

#include <functional>
#include <string>

namespace twinmap {

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

}  // namespace twinmap
