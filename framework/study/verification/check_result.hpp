#pragma once

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace twinmap {

/// One comparison of what a file holds with what it is recomputed to be.
struct CheckResult {
  std::string name;        ///< the file, and what of it
  std::string difference;  ///< the first; empty if there is none
};

struct Verification {
  std::filesystem::path folder;
  std::vector<std::string> build_differences;  ///< between the run and this program: bits may differ for them
  std::vector<std::string> notes;              ///< what could not be compared, and why
  std::vector<CheckResult> checks;

  int countDifferences() const {
    return static_cast<int>(std::count_if(
        checks.begin(), checks.end(), [](const CheckResult& check) { return !check.difference.empty(); }));
  }
  /// Adds a check; what the function throws is a difference, too.
  template <class FindDifference>
  void check(const std::string& name, const FindDifference& find_difference) {
    std::string difference;
    try {
      difference = find_difference();
    } catch (const std::exception& error) {
      difference = error.what();
    }
    checks.push_back({name, difference});
  }
};

}  // namespace twinmap
