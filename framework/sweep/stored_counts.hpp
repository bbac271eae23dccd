#pragma once

#include <filesystem>
#include <vector>

#include "framework/spec/sweep/sweep_cases.hpp"

namespace twinmap {

/// Distinct points of all cases that are simulated once each.
struct PointCounts {
  int needed = 0;
  int stored = 0;       ///< of them
  int missing = 0;      ///< not stored, for the cases that are not complete
  int simulations = 0;  ///< of the missing ones
  double bytes = 0.0;   ///< of the missing ones in chunks
};

struct StoredCounts {
  PointCounts samples;
  PointCounts neighbourhoods;  ///< listNeededNeighbourhoods, without those of samples known to have failed
};

/// What the cases need and the store has; `complete` has one value a case. Reads every chunk of the models.
StoredCounts countStored(const std::vector<SweepCase>& cases, const std::vector<bool>& complete,
                         const std::filesystem::path& store);

}  // namespace twinmap
