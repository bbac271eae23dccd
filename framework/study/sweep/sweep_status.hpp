#pragma once

#include <filesystem>
#include <string>

#include "framework/study/sweep/stored_counts.hpp"

namespace twinmap {

/// How far a sweep, or a run as its only case, is.
struct SweepStatus {
  int cases = 0;
  int complete = 0;
  int failed = 0;  ///< at the last try
  StoredCounts stored;
  std::string owner;  ///< "process 1234", which has the folder; "" if nothing is running
};

/// Reads it from the folder, changing nothing; `store` empty: the one that the run used. Throws
/// ExperimentError if there is no resolved.yaml in the folder.
SweepStatus readStatus(const std::filesystem::path& folder, const std::filesystem::path& store);

/// For people, a line a fact.
std::string describeStatus(const SweepStatus& status);

}  // namespace twinmap
