
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/signals.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/study/shards/run_shard.hpp"
#include "framework/study/shards/submission.hpp"
#include "framework/study/sweep/plan.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;

ShardOptions makeShardOptions(const SubmitArguments& arguments, const YamlNode& tree) {
  constexpr double kMinute = 60.0, kShare = 0.5;  // of the time limit: costs differ between machines
  ShardOptions options;
  options.place.folder = fs::absolute(chooseFolder(arguments.run, readExperiment(tree))).lexically_normal();
  options.place.store = arguments.run.store.empty() ? fs::path() : fs::absolute(arguments.run.store);
  options.threads = arguments.cpus;
  options.seconds = kShare * kMinute * arguments.minutes;
  options.simulate_shards = arguments.shards;
  return options;
}

SubmitOptions makeSubmitOptions(const SubmitArguments& arguments) {
  if (arguments.on == "template" && arguments.submit.empty()) {
    throw ExperimentError("--on template: needs --submit 'COMMAND {script}'");
  }
  constexpr int kMinute = 60;
  SubmitOptions options;
  options.kind = arguments.on == "slurm"      ? SchedulerKind::kSlurm
                 : arguments.on == "template" ? SchedulerKind::kTemplate
                                              : SchedulerKind::kLocal;
  options.program = fs::read_symlink("/proc/self/exe").string();
  options.threads = arguments.cpus;
  options.minutes = arguments.minutes;
  options.grace = std::min(options.grace, kMinute * options.minutes / 4);
  options.partition = arguments.partition;
  options.account = arguments.account;
  options.sbatch = arguments.sbatch;
  options.submit = arguments.submit;
  options.after = arguments.after;
  return options;
}

}  // namespace

void planShards(const SubmitArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.run.experiment.file, arguments.run.experiment.overrides);
  const ShardOptions shards = makeShardOptions(arguments, tree);
  const PlanOptions options{arguments.run.threads, chooseMemory(arguments.run)};
  silenceLog();  // of the small runs that are timed
  const ExperimentSurvey survey = surveyForShards(tree, shards.place);
  std::cout << describePlan(planRun(survey, options), options)
            << describeShards(makeShardPlan(survey, shards), shards);
}

void submit(const SubmitArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.run.experiment.file, arguments.run.experiment.overrides);
  const ShardOptions shards = makeShardOptions(arguments, tree);
  const SubmitOptions options = makeSubmitOptions(arguments);
  silenceLog();
  const SubmittedJobs jobs = submitExperiment(tree, shards, options);
  const ShardPlan plan = readShardPlan(shards.place.folder);
  std::cerr << describeShards(plan, shards);
  if (options.kind == SchedulerKind::kLocal) {
    std::cout << listCommands(shards.place.folder, plan, options.program);
  }
  for (const std::string& id : jobs.ids) {
    std::cout << id << "\n";
  }
}

void runShard(const ShardArguments& arguments) {
  const StopFlags flags = catchSignals();
  const RunControl control{arguments.threads, &flags.stop, &flags.abandon, nullptr};
  showWarningsOnly();
  std::cout << twinmap::runShard(fs::absolute(arguments.folder).lexically_normal(), arguments.shard,
                                 arguments.command_line, control)
            << "\n";
}

void cancel(const std::string& folder) {
  std::cout << cancelJobs(folder) << "\n";
}

}  // namespace twinmap::cli
