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

  void warn(Severity gravity, std::string text) { warnings.push_back({gravity, std::move(text)}); }
  void warn(Severity gravity, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      warn(gravity, text);
    }
  }
  void append(const StageNotes& later) {
    warnings.insert(warnings.end(), later.warnings.begin(), later.warnings.end());
    times.insert(times.end(), later.times.begin(), later.times.end());
  }
};

}  // namespace twinmap
