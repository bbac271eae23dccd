#pragma once

#include <string>
#include <utility>
#include <vector>

#include "framework/base/log/warning.hpp"

namespace twinmap {

/// Wall time of one stage of a run.
struct StageTime {
  std::string stage;
  double seconds = 0.0;
};

/// What stages leave beside their results.
struct StageNotes {
  std::vector<Warning> warnings;
  std::vector<StageTime> times;

  void warn(Warning warning) { warnings.push_back(std::move(warning)); }
  void warn(Severity severity, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      warn({severity, text});
    }
  }
  void append(const StageNotes& later) {
    warnings.insert(warnings.end(), later.warnings.begin(), later.warnings.end());
    times.insert(times.end(), later.times.begin(), later.times.end());
  }
};

}  // namespace twinmap
