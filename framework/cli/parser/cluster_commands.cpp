#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

void addSubmit(CLI::App& app, const Invocation& invocation) {
  const auto arguments = std::make_shared<SubmitArguments>();
  CLI::App* command = app.add_subcommand("submit", "Submit a run to a cluster, as jobs");
  command->footer("Submitted again, what is missing. --on local prints the commands instead.");
  addWhereAndHow(*command, arguments->run, invocation);
  addOn(*command, *arguments)->required();
  addJobs(*command, *arguments);
  addOption(*command, "--partition", "NAME", arguments->partition, "Of Slurm");
  addOption(*command, "--account", "NAME", arguments->account, "Of Slurm");
  addOption(*command, "--sbatch", "KEY=VALUE", arguments->sbatch,
            "Further options of Slurm's sbatch: gres=gpu:1");
  addOption(*command, "--submit", "COMMAND", arguments->submit,
            "Of a template: submits a shard and prints its job; {script}, {shard}, {name} and {after} are "
            "replaced");
  addOption(*command, "--after", "OPTION", arguments->after,
            "Of a template: what {after} stands for where a job waits for others, {jobs}");
  command->callback([arguments] { submit(*arguments); });
}

void addShard(CLI::App& app, const Invocation& invocation) {
  const auto arguments = std::make_shared<ShardArguments>();
  arguments->threads = invocation.threads;
  arguments->command_line = invocation.line;
  CLI::App* command = app.add_subcommand("shard", "Do one job of what was submitted");
  addArgument(*command, "DIR", arguments->folder, "Folder of the results");
  addArgument(*command, "N", arguments->shard, "Number of the shard");
  addThreads(*command, arguments->threads);
  command->callback([arguments] { runShard(*arguments); });
}

void addCancel(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("cancel", "Cancel the jobs of what was submitted");
  addArgument(*command, "DIR", *folder, "Folder of the results");
  command->callback([folder] { cancel(*folder); });
}

}  // namespace

void addClusterCommands(CLI::App& app, const Invocation& invocation) {
  addSubmit(app, invocation);
  addShard(app, invocation);
  addCancel(app);
}

}  // namespace twinmap::cli
