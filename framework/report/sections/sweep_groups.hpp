#pragma once

#include <string>
#include <vector>

#include "framework/base/text/csv.hpp"

namespace twinmap {

inline constexpr const char* kSizeKey = "design.train.samples";
inline constexpr const char* kNoiseKey = "noise.scale";
inline constexpr const char* kSeedKey = "seed";

/// The cases of a sweep that differ in their seed alone, for one parameter.
struct SweepGroup {
  std::string variant;  ///< the other keys: "inverse_map.gp.covariance=matern52", "" if there are none
  std::string parameter;
  double size = 0.0;   ///< NaN if not varied
  double noise = 0.0;  ///< NaN if not varied
  int seeds = 0;
  double mean = 0.0, lowest = 0.0, highest = 0.0;  ///< sd_pct over the seeds
  double coverage = 0.0;                           ///< mean of coverage95
  double limit = 0.0;                              ///< mean of limit_pct; NaN if not known
};

/// Columns of sweep.csv that were varied: key paths, which contain a '.', and the seed.
std::vector<std::string> findVariedKeys(const CsvTable& sweep);

/// In the order of their first case.
std::vector<SweepGroup> groupCases(const CsvTable& sweep);

}  // namespace twinmap
