#include <CLI/CLI.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

void addStatus(CLI::App& app) {
  const auto arguments = std::make_shared<StatusArguments>();
  CLI::App* command = app.add_subcommand("status", "Print how far a run or sweep is");
  addArgument(*command, "DIR", arguments->folder, "Folder of the results");
  addOption(*command, "--store", "DIR", arguments->store, "As given to run");
  command->callback([arguments] { status(*arguments); });
}

void addCompare(CLI::App& app) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Compare two runs, parameter by parameter");
  command->footer(
      "Prints differences with their confidence intervals, and which keys of the experiments differ.");
  addArgument(*command, "A", arguments->folder_a, "Folder of a run");
  addArgument(*command, "B", arguments->folder_b, "Folder of another run");
  CLI::Option* csv = command->add_flag("--csv", arguments->csv, "Print CSV instead of a table");
  command->add_flag("--json", arguments->json, "Print JSON instead of a table")->excludes(csv);
  command->callback([arguments] { compare(*arguments); });
}

void addReport(CLI::App& app) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Write report.html again, or one of several runs");
  addArgument(*command, "DIR", arguments->folders, "Folders of runs");
  addOption(*command, "--out", "DIR", arguments->out,
            "Folder for the report (default: the run's own; of several runs results/report)");
  addFailOnGates(*command, arguments->fail_on_gates);
  command->callback([arguments] { report(*arguments); });
}

void addVerify(CLI::App& app, const Invocation& invocation) {
  constexpr int kMostSamples = 1000000;
  const auto arguments = std::make_shared<VerifyArguments>();
  arguments->seed = std::random_device()();
  arguments->threads = invocation.threads;
  CLI::App* command = app.add_subcommand("verify", "Compute part of a run again and compare bit for bit");
  command->footer(
      "Simulates some samples again and computes all that follows from samples and hyperparameters. Of a "
      "sweep, three cases. Exit code 1 where something differs.");
  addArgument(*command, "DIR", arguments->folder, "Folder of a run or a sweep");
  addOption(*command, "--samples", "N", arguments->samples,
            "Samples of each set to simulate again (default: 5)")
      ->check(CLI::Range(0, kMostSamples));
  addOption(*command, "--seed", "S", arguments->seed,
            "Chooses the samples and cases (default: another each time)");
  command->add_flag("--all", arguments->all,
                    "Run everything again, in a temporary folder, and compare all files");
  addThreads(*command, arguments->threads);
  command->callback([arguments] { verify(*arguments); });
}

struct StoreArguments {
  std::string action, folder;
  std::vector<std::string> from;
};

void runStoreAction(const StoreArguments& arguments) {
  if ((arguments.action == "merge") == arguments.from.empty()) {
    throw CLI::ValidationError("FROM", "merge, and no other action, takes folders to copy from");
  }
  if (arguments.action == "merge") {
    mergeStore(arguments.folder, arguments.from);
  } else if (arguments.action == "prune") {
    pruneStore(arguments.folder);
  } else {
    arguments.action == "list" ? listStore(arguments.folder) : verifyStore(arguments.folder);
  }
}

void addStore(CLI::App& app) {
  const auto arguments = std::make_shared<StoreArguments>();
  CLI::App* command = app.add_subcommand("store", "List, check, merge or clean up simulated samples");
  command->footer(
      "list: models, their samples and what computed them. verify: the same after comparing every byte with "
      "its checksum. merge: copies the samples of other folders. prune: removes what is damaged, unfinished "
      "or stored twice.");
  addArgument(*command, "ACTION", arguments->action, "list, verify, merge or prune")
      ->check(CLI::IsMember({"list", "verify", "merge", "prune"}));
  addArgument(*command, "DIR", arguments->folder, "Folder of simulated samples");
  command->add_option("FROM", arguments->from, "Folders whose samples merge copies")->option_text(" ");
  command->callback([arguments] { runStoreAction(*arguments); });
}

}  // namespace

void addResultCommands(CLI::App& app, const Invocation& invocation) {
  addStatus(app);
  addCompare(app);
  addReport(app);
  addVerify(app, invocation);
  addStore(app);
}

}  // namespace twinmap::cli
