#pragma once

#include <cstdint>
#include <filesystem>
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
  std::vector<std::string> warnings;                         ///< what a person should know
  std::vector<std::pair<std::string, std::string>> digests;  ///< of the run's files, by name
};

/// provenance.json: the above with date (UTC), peak memory, version, compiler, libraries, CPU and operating
/// system.
std::string makeProvenanceJson(const Provenance& provenance);

/// Digests (hexadecimal XXH3-128) of resolved.yaml and the .h5, .csv, .md and .tex files of a run's folder,
/// by name.
std::vector<std::pair<std::string, std::string>> calcDigests(const std::filesystem::path& folder);

/// The first of the files whose digests a provenance.json has that is missing or no longer as it was written:
/// "maps.h5 is not as it was written". Empty if there is none.
std::string findChangedFile(const std::string& provenance_json, const std::filesystem::path& folder);

/// What differs between the build and machine that made a run and these ones: version, compiler, libraries,
/// instruction set, CPU: "libraries.Eigen: 3.4.0 then, 3.4.1 now". Throws std::runtime_error if the text is
/// no provenance.json.
std::vector<std::string> listBuildDifferences(const std::string& provenance_json);

}  // namespace twinmap
