#include "framework/study/sweep/sweep_status.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/files/folder_lock.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/sweep/sweep_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

std::string describeStored(const std::string& name, const PointCounts& counts) {
  return counts.needed == 0 ? "" : fmt::format("{} {} of {} stored\n", name, counts.stored, counts.needed);
}

}  // namespace

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

std::string describeStatus(const SweepStatus& status) {
  const int missing = status.cases - status.complete - status.failed;
  return fmt::format("cases:   {} of {} complete, {} failed, {} missing\n", status.complete, status.cases,
                     status.failed, missing) +
         describeStored("samples:", status.stored.samples) +
         describeStored("limits:  differences at test points:", status.stored.stencils) +
         (status.owner.empty() ? "not running\n" : "running: " + status.owner + "\n");
}

}  // namespace twinmap
