#pragma once

#include <filesystem>
#include <vector>

#include "framework/experiment/files/sweep_cases.hpp"

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
  /// For simulators without derivatives: listDerivativePoints, but for samples known to have failed.
  PointCounts stencils;
  /// Of the points of all cases, each once, group after group (groupByModel, collectPoints): whether the
  /// store lacks them.
  std::vector<bool> lacking;
};

/// What the cases need and the store has; `complete` has one value a case. Reads every chunk of the models,
/// and builds those that derivatives are needed of (some 20 ms each); 1 us a point beside.
StoredCounts countStored(const std::vector<SweepCase>& cases, const std::vector<bool>& complete,
                         const std::filesystem::path& store);

}  // namespace twinmap
