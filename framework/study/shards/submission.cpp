#include "framework/study/shards/submission.hpp"

#include <fmt/core.h>

#include <map>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/shards/shard_record.hpp"
#include "framework/study/sweep/run_sweep.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// As the run itself would: a sweep leaves open what each case resolves.
void takeFolder(const YamlNode& root, const ShardOptions& shards) {
  if (!listSweptKeys(root).empty()) {
    SweepOptions options;
    options.folder = shards.place.folder;
    options.store = shards.place.store;
    beginSweep(root, options);
    return;
  }
  const std::string resolved = writeExperiment(readExperiment(root));
  makeFolders(shards.place.folder);
  requireSameExperiment(shards.place.folder, resolved);
  writeTextFile(shards.place.folder / "resolved.yaml", resolved);
  noteStore(shards.place.folder, shards.place.store);
}

/// A line for a shard that failed, was stopped, or is not tried again.
std::string describeProblem(const ShardRecord& record, int shard, ShardKind kind) {
  const bool refused = !record.getRefusal().empty();
  const ShardState state = record.getState();
  if (!refused && state != ShardState::kFailed && state != ShardState::kInterrupted) {
    return "";
  }
  return fmt::format("{}  shard {} ({}), {}{}\n",
                     state == ShardState::kInterrupted ? "stopped:" : "failed: ", shard, getName(kind),
                     record.describeLast(),
                     refused ? "; twice the same: not tried again before the next submit" : "");
}

struct Stage {
  ShardKind kind;
  const char* what;
  double seconds;
};

}  // namespace

SubmittedJobs submitExperiment(const YamlNode& root, const ShardOptions& shards,
                               const SubmitOptions& options) {
  requireScheduler(options.kind);
  if (isQueued(shards.place.folder)) {
    throw std::runtime_error(shards.place.folder.string() +
                             ": has jobs that are queued or running; 'twinmap cancel' ends them");
  }
  const ShardPlan plan = makeShardPlan(surveyForShards(root, shards.place), shards);
  takeFolder(root, shards);
  makeFolders(getClusterFolder(shards.place.folder));
  fs::remove_all(getClusterFolder(shards.place.folder) / "shards");
  writeShardPlan(shards.place.folder, plan);
  return submitJobs(shards.place.folder, plan, options);
}

std::string describeShards(const ShardPlan& plan, const ShardOptions& shards) {
  constexpr double kMinute = 60.0, kMebi = 1024.0 * 1024.0;
  std::string text;
  for (const Stage& stage : {Stage{ShardKind::kSimulate, "samples", plan.simulate_s},
                             Stage{ShardKind::kCases, "cases", plan.cases_s}}) {
    if (const int count = plan.count(stage.kind); count > 0) {
      text += fmt::format("shards:      {} of {}, about {:.2g} min each on {} threads\n", count, stage.what,
                          stage.seconds / count / shards.threads / kMinute, shards.threads);
    }
  }
  return text + fmt::format("             1 of tables and report\nof a shard:  about {:.0f} MiB of memory\n",
                            plan.memory / kMebi);
}

std::string listCommands(const fs::path& folder, const ShardPlan& plan, const std::string& program) {
  std::string text;
  int first = 0;
  for (const ShardKind stage : {ShardKind::kSimulate, ShardKind::kCases, ShardKind::kFinish}) {
    if (const int count = plan.count(stage); count > 0) {
      text += fmt::format("seq {} {} | xargs -n 1 -P 1 {} shard {}\n", first, first + count - 1,
                          quoteForShell(program), quoteForShell(folder.string()));
      first += count;
    }
  }
  return text;
}

std::string describeSubmission(const fs::path& folder) {
  if (!fs::exists(getClusterFolder(folder) / "plan.json")) {
    return "";
  }
  const ShardPlan plan = readShardPlan(folder);
  std::map<std::string, int> count;
  std::string problems;
  for (int i = 0; i < static_cast<int>(plan.shards.size()); ++i) {
    const ShardRecord record(folder, i);
    ++count[getName(record.getState())];
    problems += describeProblem(record, i, plan.shards[static_cast<std::size_t>(i)].kind);
  }
  std::string states;
  for (const auto& [state, number] : count) {
    states += fmt::format("{}{} {}", states.empty() ? "" : ", ", number, state);
  }
  const std::string queue = describeQueue(folder);
  return "shards:  " + states + "\n" + problems + (queue.empty() ? "" : "jobs:    " + queue + "\n");
}

}  // namespace twinmap
