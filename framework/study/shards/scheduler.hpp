#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/study/shards/shard_plan.hpp"

namespace twinmap {

/// Who runs the shards.
enum class SchedulerKind {
  kSlurm,
  kTemplate,  ///< any other, by the user's command
  kLocal,     ///< nobody: the commands are printed
};

/// How jobs are submitted.
struct SubmitOptions {
  SchedulerKind kind = SchedulerKind::kSlurm;
  std::string program;              ///< twinmap, as the nodes find it
  int threads = 1;                  ///< of each job
  int minutes = 60;                 ///< time limit of a job
  int grace = 120;                  ///< s before the time limit at which a job is told to save and end; Slurm
                                    ///< looks every 30 s
  std::string partition, account;   ///< empty: the scheduler's default
  std::vector<std::string> sbatch;  ///< further options, "KEY=VALUE" or "KEY"
  /// Submits one shard, for kTemplate: "qsub -N {name} {after} -v SHARD={shard} {script}".
  std::string submit;
  /// What {after} stands for where a stage waits for jobs: "-W depend=afterany:{jobs}".
  std::string after;
};

/// A submission's jobs: DIR/cluster/jobs.json.
struct SubmittedJobs {
  SchedulerKind kind = SchedulerKind::kLocal;
  std::vector<std::string> ids;
};

/// Throws std::runtime_error, in one line, where the scheduler's commands are not there.
void requireScheduler(SchedulerKind kind);

/// Writes the script of each stage to DIR/cluster. Returns their files.
std::vector<std::filesystem::path> writeScripts(const std::filesystem::path& folder, const ShardPlan& plan,
                                                const SubmitOptions& options);

/// Submits the shards of the plan in `folder`, each stage to begin when the one before has ended however, and
/// notes the jobs. Nothing is submitted for kLocal. Throws std::runtime_error with the scheduler's words
/// where it refuses, or if it is not there; jobs submitted before that are cancelled.
SubmittedJobs submitJobs(const std::filesystem::path& folder, const ShardPlan& plan,
                         const SubmitOptions& options);

/// Jobs that no cancel or end has followed, as Slurm says: "pending", "running" ... with their number; empty
/// where it cannot be asked.
std::string describeQueue(const std::filesystem::path& folder);
/// Whether jobs of an earlier submission are still queued or running.
bool isQueued(const std::filesystem::path& folder);

/// Cancels the jobs in the folder; says what it did.
std::string cancelJobs(const std::filesystem::path& folder);

}  // namespace twinmap
