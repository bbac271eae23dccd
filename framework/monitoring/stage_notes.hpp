#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// Wall time of one stage of a run.
struct StageTime {
  std::string stage;
  double seconds = 0.0;
};

/// What stages leave beside their results.
struct StageNotes {
  std::vector<std::string> warnings;  ///< for people
  std::vector<StageTime> times;

  void append(const StageNotes& later) {
    warnings.insert(warnings.end(), later.warnings.begin(), later.warnings.end());
    times.insert(times.end(), later.times.begin(), later.times.end());
  }
};

}  // namespace twinmap
