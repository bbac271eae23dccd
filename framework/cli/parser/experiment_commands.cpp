#include <CLI/CLI.hpp>
#include <memory>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

void addCheck(CLI::App& app) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command =
      app.add_subcommand("check", "Check an experiment file and print it with all its defaults");
  command->footer(
      "Reads the file, builds the model at the centre of the bounds with its initial state, and simulates "
      "nothing.");
  addExperiment(*command, arguments->experiment);
  command->add_flag("--full", arguments->full, "Print long tables with all their values");
  command->add_option("--svg", arguments->svg, "File for a picture of the mechanism")->type_name("FILE");
  command->callback([arguments] { check(*arguments); });
}

void addSimulate(CLI::App& app) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand("simulate", "Simulate one sample and print its outputs");
  command->footer(
      "Prints the outputs at the times of the features, and the modes, as CSV. Parameters are at the centre "
      "of their bounds unless given: parameters.NAME=VALUE, nuisance.NAME=VALUE, inputs.NAME=VALUE.");
  addExperiment(*command, arguments->experiment);
  addOption(*command, "--csv", "OUT", arguments->csv, "Write to this file instead of the standard output");
  command->add_flag("--noise", arguments->noise, "Add the experiment's measurement noise");
  command->callback([arguments] { simulate(*arguments); });
}

void addRun(CLI::App& app, const Invocation& invocation) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Simulate, train an estimator, test it and report");
  command->footer(
      "Leaves tables, the trained estimator (maps.h5) and report.html in the folder. Stopped by Ctrl-C, the "
      "same command continues.\n\nExit codes: 0 done, 1 failed, 2 wrong usage or experiment file, 3 a gate "
      "failed and --fail-on-gates was given, 130 and 143 stopped by Ctrl-C or SIGTERM.");
  addWhereAndHow(*command, *arguments, invocation);
  CLI::Option* fail_fast = command->add_flag("--fail-fast", arguments->fail_fast,
                                             "Of a sweep: begin no case after one has failed");
  command->add_flag("--keep-going", "Of a sweep: a case that fails stops no other (default)")
      ->excludes(fail_fast);
  addFailOnGates(*command, arguments->fail_on_gates);
  command->add_flag("--quiet", arguments->quiet, "No progress, only warnings and errors");
  command->add_flag("--features-only", arguments->features_only,
                    "Simulate, write the points and noisy features of all samples to features.h5, and train "
                    "nothing; memory does not grow with the samples");
  command->callback([arguments] { run(*arguments); });
}

void addPlan(CLI::App& app, const Invocation& invocation) {
  const auto arguments = std::make_shared<SubmitArguments>();
  CLI::App* command =
      app.add_subcommand("plan", "Print what run would take: simulations, time, memory, disk");
  addWhereAndHow(*command, arguments->run, invocation);
  CLI::Option* on = addOn(*command, *arguments);
  on->description("Print the shards as well that submit would make: " + on->get_description());
  addJobs(*command, *arguments);
  command->callback([arguments, on] { on->count() > 0 ? planShards(*arguments) : plan(arguments->run); });
}

void addDesign(CLI::App& app, const Invocation& invocation) {
  const auto arguments = std::make_shared<DesignArguments>();
  arguments->threads = invocation.threads;
  arguments->command_line = invocation.line;
  CLI::App* command =
      app.add_subcommand("design", "Find the excitation or sensors that determine the parameters best");
  command->footer(
      "excitation: chooses the free values of the signals (design.excitation) within limits. sensors: "
      "chooses which outputs to measure, and when (design.sensors). Writes designed.yaml, tables, the "
      "signals as CSV and a page of what is gained.");
  addArgument(*command, "WHAT", arguments->what, "excitation or sensors")
      ->check(CLI::IsMember({"excitation", "sensors"}));
  addExperiment(*command, arguments->experiment);
  addOption(*command, "--out", "DIR", arguments->folder,
            "Folder for the results (default: results/NAME_design)");
  command->add_flag("--verify", arguments->verify,
                    "Train maps on the experiment before and after, with as many simulations, and compare "
                    "what they infer of held-out samples");
  addThreads(*command, arguments->threads);
  command->callback([arguments] {
    arguments->what == "sensors" ? designSensors(*arguments) : designExcitation(*arguments);
  });
}

}  // namespace

void addExperimentCommands(CLI::App& app, const Invocation& invocation) {
  addCheck(app);
  addSimulate(app);
  addRun(app, invocation);
  addPlan(app, invocation);
  addDesign(app, invocation);
}

}  // namespace twinmap::cli
