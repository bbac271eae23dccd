#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace twinmap {

/// How much a warning matters, the most severe first.
enum class Severity {
  kMisleading,  ///< answers, or what is said of them, may be wrong
  kDegraded,    ///< answers are worse than they could be
  kInfo         ///< something to know
};

/// Human-readable; given once for all parameters that it concerns.
struct Warning {
  Severity severity = Severity::kInfo;
  std::string text;
};

/// The texts, the most severe first; of the same severity in the order given.
inline std::vector<std::string> listTexts(std::vector<Warning> warnings) {
  std::stable_sort(warnings.begin(), warnings.end(),
                   [](const Warning& a, const Warning& b) { return a.severity < b.severity; });
  std::vector<std::string> texts;
  for (Warning& warning : warnings) {
    texts.push_back(std::move(warning.text));
  }
  return texts;
}

}  // namespace twinmap
