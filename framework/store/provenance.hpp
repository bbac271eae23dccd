#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace twinmap {

/// How a run came about.
struct Provenance {
  std::string command;  ///< the command line
  std::uint64_t seed = 0;
  int threads = 0;
  std::vector<std::pair<std::string, double>> stage_seconds;  ///< wall time of each stage, in order
  int failed_samples = 0;
  int reused_samples = 0;  ///< taken from the store instead of simulated
  int online_updates = 0;  ///< timed, one at a time
  double online_median_us = 0.0, online_p99_us = 0.0;
  std::vector<std::string> warnings;  ///< what a person should know
};

/// provenance.json: the above with date (UTC), peak memory, version, compiler, libraries, CPU and operating
/// system.
std::string makeProvenanceJson(const Provenance& provenance);

}  // namespace twinmap
