#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>

#include "framework/base/files/folder_lock.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/shards/submission.hpp"
#include "framework/study/sweep/stored_counts.hpp"
#include "framework/study/sweep/sweep_folder.hpp"

namespace twinmap::cli {
namespace {

/// How far a sweep, or a run as its only case, is.
struct SweepStatus {
  int cases = 0;
  int complete = 0;
  int failed = 0;  ///< at the last try
  StoredCounts stored;
  std::string owner;  ///< "process 1234", which has the folder; "" if nothing is running
};

namespace fs = std::filesystem;

std::string describeStored(const std::string& name, const PointCounts& counts) {
  return counts.needed == 0 ? "" : fmt::format("{} {} of {} stored\n", name, counts.stored, counts.needed);
}

/// Reads it from the folder, changing nothing; `store` empty: the one that the run used. Throws
/// ExperimentError if there is no resolved.yaml in the folder.
SweepStatus readStatus(const fs::path& folder, const fs::path& store) {
  const fs::path resolved = folder / "resolved.yaml";
  if (!fs::exists(resolved)) {
    throw ExperimentError(folder.string() + ": is not a folder of a run: it has no resolved.yaml");
  }
  const YamlNode root = loadYaml(resolved.string());
  const bool is_sweep = root.find("sweep") != nullptr;
  std::vector<SweepCase> cases = expandCasesWithSignals(root);
  followNoise(cases);
  SweepStatus status;
  status.owner = findLockOwner(folder);
  status.cases = static_cast<int>(cases.size());
  const std::vector<bool> complete =
      is_sweep ? findComplete(folder, cases) : std::vector<bool>{isComplete(folder)};
  status.complete = static_cast<int>(std::count(complete.begin(), complete.end(), true));
  const std::vector<std::string> failed = readFailedCases(folder);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    status.failed += !complete[i] && std::count(failed.begin(), failed.end(), cases[i].name) > 0 ? 1 : 0;
  }
  status.stored = countStored(cases, complete, store.empty() ? findStore(folder) : store);
  return status;
}

/// For people, a line a fact.
std::string describeStatus(const SweepStatus& status) {
  const int missing = status.cases - status.complete - status.failed;
  return fmt::format("cases:   {} of {} complete, {} failed, {} missing\n", status.complete, status.cases,
                     status.failed, missing) +
         describeStored("samples:", status.stored.samples) +
         describeStored("limits:  differences at test points:", status.stored.stencils) +
         (status.owner.empty() ? "not running\n" : "running: " + status.owner + "\n");
}

}  // namespace

void status(const StatusArguments& arguments) {
  std::cout << describeStatus(readStatus(arguments.folder, arguments.store))
            << describeSubmission(arguments.folder);
}

}  // namespace twinmap::cli
