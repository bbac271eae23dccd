#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "framework/study/verification/check_result.hpp"

namespace twinmap {

struct VerifyOptions {
  int samples = 5;         ///< of each set that are simulated again
  std::uint64_t seed = 1;  ///< chooses them
  bool all = false;        ///< run the whole experiment again instead
  int threads = 1;
};

/// Recomputes a part of a run from its resolved.yaml and compares bit for bit:
///   all files        their digests in provenance.json
///   samples.h5       parameters, names and times of all samples; the responses of some, simulated again
///   chunks           checksums, and the responses of all samples that they hold
///   maps.h5          all but the end of the search: transform, training inputs, processes, left-out samples
///   predictions.csv  all test samples, inferred again; the information limit of those simulated again
///   metrics.csv, joint.csv, pit.csv, tables   all of them
/// What samples.h5 has wrong does not spread: later checks use the responses that were simulated again and
/// those of the chunks. With `all` the whole experiment is run in a temporary folder, and all files are
/// compared. The folder is not written to. Throws ExperimentError if it is not that of a finished run.
Verification verifyRun(const std::filesystem::path& folder, const VerifyOptions& options);

/// `count` of `total` indices, ascending, by the seed; all if there are not more.
std::vector<int> chooseSome(int count, int total, std::uint64_t seed, int stream);

}  // namespace twinmap
