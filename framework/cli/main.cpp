#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <random>
#include <thread>
#include <twinmap/build_info.hpp>

#include "framework/cli/commands.hpp"
#include "framework/cli/completion.hpp"
#include "framework/cli/log.hpp"
#include "framework/cli/signals.hpp"
#include "framework/fmi/worker.hpp"
#include "framework/monitoring/interrupted.hpp"
#include "framework/spec/yaml/source_location.hpp"

namespace cli = twinmap::cli;

namespace {

constexpr int kFailed = 1;
constexpr int kWrongInput = 2;
constexpr int kGatesFailed = 3;
constexpr int kInterrupted = 128;  // plus the signal's number, as shells say it

std::string joinArguments(int count, char** arguments) {
  std::string line = "twinmap";
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool plain = argument.find_first_of(" '\"[]{}$*?;&|<>()") == std::string::npos;
    line += plain ? " " + argument : " '" + argument + "'";
  }
  return line;
}

void addExperiment(CLI::App& command, cli::ExperimentArguments& arguments) {
  command.add_option("FILE", arguments.file, "Experiment file (YAML)")->required()->option_text(" ");
  command
      .add_option("key.path=value", arguments.overrides,
                  "Overrides of values in the file: noise.scale=2 'parameters.k_y.bounds=[4, 16]'; lists and "
                  "ranges sweep: design.train.samples=100,200 seed=1..10")
      ->option_text(" ");
}

void addCheck(CLI::App& app, cli::ExperimentArguments& arguments) {
  CLI::App* command = app.add_subcommand("check",
                                         "Validate an experiment, build its model at the centre of the "
                                         "bounds, and print all with defaults; simulate nothing");
  addExperiment(*command, arguments);
  command->callback([&arguments] { cli::check(arguments); });
}

void addSimulate(CLI::App& app, cli::SimulateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Simulate once and write the outputs at the features' times, and modes, as CSV. The parameters are at "
      "the centre of their bounds, unless given as parameters.NAME=VALUE (nuisance.NAME, inputs.NAME)");
  addExperiment(*command, arguments.experiment);
  command->add_option("--csv", arguments.csv, "Write to this file instead of the standard output")
      ->type_name("OUT");
  command->add_flag("--noise", arguments.noise, "Add the experiment's measurement noise");
  command->callback([&arguments] { cli::simulate(arguments); });
}

void addFailOnGates(CLI::App& command, bool& fail) {
  command.add_flag("--fail-on-gates", fail, "Exit with 3 if one of the experiment's gates fails");
}

void addThreads(CLI::App& command, int& threads) {
  constexpr int kMostThreads = 1024;
  command.add_option("--threads", threads, "Threads (default: all cores); results do not depend on them")
      ->type_name("N")
      ->check(CLI::Range(1, kMostThreads));
}

void addWhereAndHow(CLI::App& command, cli::RunArguments& arguments) {
  addExperiment(command, arguments.experiment);
  command.add_option("--out", arguments.folder, "Folder for the results (default: results/NAME)")
      ->type_name("DIR");
  command
      .add_option("--store", arguments.store,
                  "Folder of simulated samples, shared with other runs (default: chunks in the run's folder)")
      ->type_name("DIR");
  addThreads(command, arguments.threads);
  command
      .add_option("--memory", arguments.memory,
                  "Memory that the cases of a sweep may take together (default: half of the machine's)")
      ->type_name("GIB")
      ->check(CLI::PositiveNumber);
}

void addRun(CLI::App& app, cli::RunArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("run", "Simulate, train, infer, and write tables, maps and the report");
  addWhereAndHow(*command, arguments);
  CLI::Option* fail_fast =
      command->add_flag("--fail-fast", arguments.fail_fast, "Of a sweep: begin no case after one has failed");
  command->add_flag("--keep-going", "Of a sweep: a case that fails stops no other (default)")
      ->excludes(fail_fast);
  addFailOnGates(*command, arguments.fail_on_gates);
  command->add_flag("--quiet", arguments.quiet, "No progress, only warnings and errors");
  command->callback([&arguments] { cli::run(arguments); });
}

void addJobs(CLI::App& command, cli::SubmitArguments& arguments) {
  constexpr int kLongest = 100000, kMostCpus = 1024, kMostShards = 1000;
  command.add_option("--time", arguments.minutes, "Time limit of a job; min (default: 60)")
      ->type_name("MINUTES")
      ->check(CLI::Range(1, kLongest));
  command.add_option("--cpus", arguments.cpus, "Threads of a job (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(1, kMostCpus));
  command
      .add_option("--shards", arguments.shards,
                  "Jobs that simulate (default: such that each takes half of the time limit)")
      ->type_name("N")
      ->check(CLI::Range(1, kMostShards));
}

CLI::Option* addOn(CLI::App& command, cli::SubmitArguments& arguments) {
  return command.add_option("--on", arguments.on, "slurm, template or local")
      ->type_name("SCHEDULER")
      ->check(CLI::IsMember({"slurm", "template", "local"}));
}

void addSubmit(CLI::App& app, cli::SubmitArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "submit",
      "Submit what run would do to a cluster, as jobs that each do a shard of it; or print the commands "
      "(--on local); submitted again, what is missing");
  addWhereAndHow(*command, arguments.run);
  addOn(*command, arguments)->required();
  addJobs(*command, arguments);
  command->add_option("--partition", arguments.partition, "Of Slurm")->type_name("NAME");
  command->add_option("--account", arguments.account, "Of Slurm")->type_name("NAME");
  command->add_option("--sbatch", arguments.sbatch, "Further options of Slurm's sbatch: gres=gpu:1")
      ->type_name("KEY=VALUE");
  command
      ->add_option(
          "--submit", arguments.submit,
          "Of a template: submits a shard and prints its job; {script}, {shard}, {name} and {after} are "
          "replaced")
      ->type_name("COMMAND");
  command
      ->add_option("--after", arguments.after,
                   "Of a template: what {after} stands for where a job waits for others, {jobs}")
      ->type_name("OPTION");
  command->callback([&arguments] { cli::submit(arguments); });
}

void addShard(CLI::App& app, cli::ShardArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "shard", "Do one shard of what was submitted: simulate samples, train cases, or write tables");
  command->add_option("DIR", arguments.folder, "Folder of the results")->required()->option_text(" ");
  command->add_option("N", arguments.shard, "Number of the shard")->required()->option_text(" ");
  addThreads(*command, arguments.threads);
  command->callback([&arguments] { cli::runShard(arguments); });
}

void addCancel(CLI::App& app, std::string& folder) {
  CLI::App* command = app.add_subcommand("cancel", "Cancel the jobs of what was submitted");
  command->add_option("DIR", folder, "Folder of the results")->required()->option_text(" ");
  command->callback([&folder] { cli::cancel(folder); });
}

void addPlan(CLI::App& app, cli::RunArguments& arguments, cli::SubmitArguments& submitted) {
  CLI::App* command = app.add_subcommand(
      "plan",
      "Print what run would do: cases, simulations, time, memory, disk; simulate and train only a little");
  addWhereAndHow(*command, arguments);
  CLI::Option* on = addOn(*command, submitted);
  on->description("Print the shards as well that submit would make: " + on->get_description());
  addJobs(*command, submitted);
  command->callback([&arguments, &submitted, on] {
    submitted.run = arguments;
    on->count() > 0 ? cli::planShards(submitted) : cli::plan(arguments);
  });
}

void addStatus(CLI::App& app, cli::StatusArguments& arguments) {
  CLI::App* command = app.add_subcommand("status", "Print how far a sweep or a run is");
  command->add_option("DIR", arguments.folder, "Folder of the results")->required()->option_text(" ");
  command->add_option("--store", arguments.store, "As given to run")->type_name("DIR");
  command->callback([&arguments] { cli::status(arguments); });
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
    cli::mergeStore(arguments.folder, arguments.from);
  } else if (arguments.action == "prune") {
    cli::pruneStore(arguments.folder);
  } else {
    arguments.action == "list" ? cli::listStore(arguments.folder) : cli::verifyStore(arguments.folder);
  }
}

void addStore(CLI::App& app, StoreArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "store",
      "Look after a folder of simulated samples (run --store). list: the models, their samples and what "
      "computed them; verify: the same after comparing every byte with its checksum; merge: copy the samples "
      "of other folders into it; prune: remove what is damaged, left by interrupted writes, or stored twice");
  command->add_option("ACTION", arguments.action, "list, verify, merge or prune")
      ->required()
      ->check(CLI::IsMember({"list", "verify", "merge", "prune"}))
      ->option_text(" ");
  command->add_option("DIR", arguments.folder, "Folder of simulated samples")->required()->option_text(" ");
  command->add_option("FROM", arguments.from, "Folders whose samples merge copies")->option_text(" ");
  command->callback([&arguments] { runStoreAction(arguments); });
}

void addDesign(CLI::App& app, cli::DesignArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "design",
      "Choose an experiment that tells most about the parameters, by the information limit. excitation: the "
      "free values of its signals (design.excitation) within limits. sensors: which outputs to measure, and "
      "when "
      "(design.sensors). Writes designed.yaml, tables, the signals as CSV, and a page of what it brings");
  command->add_option("WHAT", arguments.what, "excitation or sensors")
      ->required()
      ->check(CLI::IsMember({"excitation", "sensors"}))
      ->option_text(" ");
  addExperiment(*command, arguments.experiment);
  command->add_option("--out", arguments.folder, "Folder for the results (default: results/NAME_design)")
      ->type_name("DIR");
  command->add_flag(
      "--verify", arguments.verify,
      "Train maps on the experiment before and after, with as many simulations, and compare what "
      "they infer of held-out samples");
  addThreads(*command, arguments.threads);
  command->callback([&arguments] {
    arguments.what == "sensors" ? cli::designSensors(arguments) : cli::designExcitation(arguments);
  });
}

void addCompare(CLI::App& app, cli::CompareArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Print the same parameters of two runs side by side, with confidence intervals of the differences, and "
      "which keys of their experiments differ");
  command->add_option("A", arguments.folder_a, "Folder of a run")->required()->option_text(" ");
  command->add_option("B", arguments.folder_b, "Folder of another run")->required()->option_text(" ");
  CLI::Option* csv = command->add_flag("--csv", arguments.csv, "Print CSV instead of a table");
  command->add_flag("--json", arguments.json, "Print JSON instead of a table")->excludes(csv);
  command->callback([&arguments] { cli::compare(arguments); });
}

void addNoise(CLI::App& app, cli::NoiseArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "noise",
      "Estimate the noise of a measurement while nothing moves (or of residuals): standard deviation and "
      "autoregressive model of each column, and the same as YAML for an experiment file");
  command->add_option("MEASUREMENT", arguments.measurement, "CSV, MATLAB or HDF5 file")
      ->required()
      ->option_text(" ");
  command->add_option("--window", arguments.window, "Times from A to B only; s (default: all)")
      ->type_name("A,B")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--columns", arguments.columns, "Columns, or outputs of the experiment (default: all)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--experiment", arguments.experiment,
                   "Experiment file whose 'measurement' says where its outputs stand, and in which units")
      ->type_name("FILE");
  command->add_flag("--json", arguments.json, "Print JSON");
  command->callback([&arguments] { cli::noise(arguments); });
}

void addReport(CLI::App& app, cli::ReportArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "report", "Write report.html again from a run's or a sweep's folder, or compare several runs");
  command->add_option("DIR", arguments.folders, "Folders of runs")->required()->option_text(" ");
  command
      ->add_option("--out", arguments.out,
                   "Folder for the report (default: the run's own; of several runs results/report)")
      ->type_name("DIR");
  addFailOnGates(*command, arguments.fail_on_gates);
  command->callback([&arguments] { cli::report(arguments); });
}

/// Both flags overrule what the experiment says.
void addRefine(CLI::App& command, std::optional<bool>& refine) {
  CLI::Option* on = command.add_flag_callback(
      "--refine", [&refine] { refine = true; },
      "Refine what was inferred by least squares on the simulator, accepted by a test (default: as the "
      "experiment's 'refine' says)");
  command
      .add_flag_callback(
          "--no-refine", [&refine] { refine = false; }, "Leave it as the map infers it")
      ->excludes(on);
}

void addInfer(CLI::App& app, cli::InferArguments& arguments) {
  CLI::App* command = app.add_subcommand("infer",
                                         "Infer the parameters of measured responses with a trained map: "
                                         "mean, sd and 95 % interval of each, and "
                                         "whether to trust them");
  command->add_option("RUN", arguments.run, "Folder of a finished run, or its maps.h5")
      ->required()
      ->option_text(" ");
  command
      ->add_option("MEASUREMENT", arguments.files,
                   "Files: CSV, MATLAB .mat or HDF5, with a column of times and one for each output")
      ->option_text(" ");
  command->add_option("--set", arguments.known, "Value of a known input of the set-up; for each of them")
      ->type_name("NAME=VALUE");
  command
      ->add_option("--start", arguments.starts,
                   "Time in the file (s) at which the model's time is 0; several infer several windows")
      ->type_name("S");
  CLI::Option* csv = command->add_flag("--csv", arguments.csv, "Print CSV instead of a table");
  command->add_flag("--json", arguments.json, "Print a line of JSON per measurement")->excludes(csv);
  command
      ->add_flag(
          "--follow", arguments.follow,
          "Read CSV measurements one after another from the standard input, each ended by an empty line, "
          "and print a line of JSON for each at once")
      ->excludes(csv);
  addRefine(*command, arguments.refine);
  CLI::Option* posterior = command->add_flag(
      "--posterior{512}", arguments.posterior_draws,
      "The posterior as well, without a normal approximation: quantiles, from so many draws weighted by a "
      "surrogate's likelihood; --posterior=2000 for more than 512");
  command->add_option("--draws", arguments.draws, "File for the posterior's joint draws (CSV)")
      ->type_name("FILE")
      ->needs(posterior);
  command->callback([&arguments] { cli::infer(arguments); });
}

void addExport(CLI::App& app, cli::ExportArguments& arguments) {
  CLI::App* command = app.add_subcommand("export",
                                         "Write a trained map for other programs: C99 without heap or "
                                         "libraries, an FMU, or its numbers as JSON");
  command->add_option("RUN", arguments.run, "Folder of a finished run")->required()->option_text(" ");
  command->add_option("--c", arguments.c_folder, "Folder for C sources with a self-test and README.md")
      ->type_name("DIR");
  CLI::Option* fmu = command->add_option("--fmu", arguments.fmu, "File for an FMU for Co-Simulation");
  fmu->type_name("FILE");
  command->add_option("--fmi", arguments.fmi, "Version of the FMU: 2 or 3 (default: 3)")
      ->type_name("N")
      ->check(CLI::IsMember({2, 3}))
      ->needs(fmu);
  command->add_option("--json", arguments.json, "File for all numbers as JSON")->type_name("FILE");
  command->add_flag("--float", arguments.single,
                    "C in float where that keeps what it says (default: double)");
  command->add_flag("--compress", arguments.compressed,
                    "C of processes with so few inducing inputs that at most 2 % of an sd is lost");
  command->add_flag_callback(
      "--no-trust", [&arguments] { arguments.trust = false; }, "C without the trust status");
  command->add_option("--prefix", arguments.prefix, "Of names and files in C (default: twinmap)")
      ->type_name("NAME");
  command->callback([&arguments] { cli::exportMap(arguments); });
}

void addReplay(CLI::App& app, cli::ReplayArguments& arguments) {
  constexpr int kFewestDraws = 2, kMostDraws = 10000;
  CLI::App* command =
      app.add_subcommand("replay",
                         "Infer the parameters of a measured response, simulate the updated model next to "
                         "it, and report how well "
                         "it follows: tables and a page with the measured, nominal and updated responses");
  command->add_option("RUN", arguments.run, "Folder of a finished run, or its maps.h5")
      ->required()
      ->option_text(" ");
  command->add_option("MEASUREMENT", arguments.file, "File: CSV, MATLAB .mat or HDF5, as infer takes them")
      ->required()
      ->option_text(" ");
  command->add_option("--start", arguments.start, "Time in the file (s) at which the model's time is 0")
      ->type_name("S");
  command
      ->add_option("--from", arguments.from,
                   "Infer the parameters from this measurement instead (default: the same file)")
      ->type_name("FILE");
  command->add_option("--from-start", arguments.from_start, "Where its window starts (default: as --start)")
      ->type_name("S");
  command->add_option("--set", arguments.known, "Value of a known input of the set-up; for each of them")
      ->type_name("NAME=VALUE");
  addRefine(*command, arguments.refine);
  command
      ->add_option("--draws", arguments.draws,
                   "Simulations with parameters drawn from what was inferred, for the band (default: 50)")
      ->type_name("N")
      ->check(CLI::Range(kFewestDraws, kMostDraws));
  addThreads(*command, arguments.threads);
  command->add_option("--out", arguments.out, "Folder for the results (default: RUN/replay/NAME of the file)")
      ->type_name("DIR");
  command->callback([&arguments] { cli::replay(arguments); });
}

void addVerify(CLI::App& app, cli::VerifyArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "verify",
      "Recompute a random part of a run from its resolved.yaml and compare bit for bit: some samples are "
      "simulated again, everything that follows from samples and hyperparameters is computed again. Of a "
      "sweep, three of its cases. Exit code 1 where something differs");
  command->add_option("DIR", arguments.folder, "Folder of a run or a sweep")->required()->option_text(" ");
  command->add_option("--samples", arguments.samples, "Samples of each set to simulate again (default: 5)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--seed", arguments.seed, "Chooses the samples and cases (default: another each time)")
      ->type_name("S");
  command->add_flag("--all", arguments.all,
                    "Run everything again, in a temporary folder, and compare all files");
  addThreads(*command, arguments.threads);
  command->callback([&arguments] { cli::verify(arguments); });
}

void addSchema(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "schema", "Print the JSON schema of experiment files, with which editors complete and explain keys");
  command->callback([] { cli::printSchema(); });
}

void addVariables(CLI::App& app, std::string& file) {
  CLI::App* command = app.add_subcommand(
      "variables",
      "Print the variables of an FMU, which an experiment can name: causality, type, unit, start value");
  command->add_option("FMU", file, "File of FMI 2.0 or 3.0")->required()->option_text(" ");
  command->callback([&file] { cli::printVariables(file); });
}

cli::Taken findTakenBy(const std::string& value) {
  constexpr std::array kFiles = {"FILE", "FMU", "MEASUREMENT", "OUT", "RUN"};
  constexpr std::array kFolders = {"DIR", "A", "B", "FROM"};
  const auto is_value = [&](const char* one) { return value == one; };
  return std::any_of(kFiles.begin(), kFiles.end(), is_value)       ? cli::Taken::kFile
         : std::any_of(kFolders.begin(), kFolders.end(), is_value) ? cli::Taken::kFolder
                                                                   : cli::Taken::kOther;
}

cli::OptionDescription describe(const CLI::Option& option) {
  if (option.get_positional()) {
    return {{option.get_name()}, option.get_description(), option.get_name(), findTakenBy(option.get_name())};
  }
  cli::OptionDescription described;
  for (const std::string& name : option.get_lnames()) {
    described.names.push_back("--" + name);
  }
  for (const std::string& name : option.get_snames()) {
    described.names.push_back("-" + name);
  }
  described.description = option.get_description();
  if (option.get_expected_max() > 0) {
    const std::string type = option.get_type_name();  // "N:INT in [1 - 1024]"
    described.value = type.substr(0, type.find(':'));
    described.taken = findTakenBy(described.value);
  }
  return described;
}

std::vector<cli::CommandDescription> describe(const CLI::App& app) {
  std::vector<cli::CommandDescription> commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    cli::CommandDescription described{command->get_name(), command->get_description(), {}, {}};
    for (const CLI::Option* option : command->get_options()) {
      (option->get_positional() ? described.arguments : described.options).push_back(describe(*option));
    }
    commands.push_back(described);
  }
  return commands;
}

void addCompletion(CLI::App& app, std::string& shell) {
  CLI::App* command = app.add_subcommand(
      "completion",
      "Print a script that completes command lines: source it, or install it where the shell "
      "looks for such scripts");
  command->add_option("SHELL", shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->option_text(" ");
  command->callback([&app, &shell] { std::cout << cli::makeCompletion(shell, describe(app)); });
}

int runCommand(int count, char** arguments) {
  CLI::App app(
      "twinmap keeps digital twins true: it simulates a model for many parameter sets, trains maps "
      "from features of the response to the parameters, and infers parameters with their standard "
      "deviation.");
  app.name("twinmap");  // in the help, wherever the program lies
  app.set_version_flag("--version", std::string("twinmap ") + twinmap::kVersion);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 wrong usage or wrong experiment file, 3 a gate failed and "
      "--fail-on-gates was given, 130 and 143 interrupted by Ctrl-C or SIGTERM.");

  cli::ExperimentArguments check;
  cli::SimulateArguments simulate;
  cli::CompareArguments compare;
  cli::NoiseArguments noise;
  cli::ReportArguments report;
  cli::StatusArguments status;
  cli::RunArguments run;
  cli::VerifyArguments verify;
  cli::InferArguments infer;
  std::string variables, shell;
  cli::ReplayArguments replay;
  verify.seed = std::random_device()();
  replay.threads = verify.threads = run.threads =
      static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  run.command_line = joinArguments(count, arguments);
  addCheck(app, check);
  addSimulate(app, simulate);
  addRun(app, run);
  cli::SubmitArguments submitted;
  cli::ShardArguments shard;
  std::string cancelled;
  submitted.run.threads = shard.threads = run.threads;
  shard.command_line = run.command_line;
  addPlan(app, run, submitted);
  addSubmit(app, submitted);
  addShard(app, shard);
  addCancel(app, cancelled);
  addInfer(app, infer);
  cli::ExportArguments exported;
  addExport(app, exported);
  addReplay(app, replay);
  addStatus(app, status);
  StoreArguments store;
  addStore(app, store);
  cli::DesignArguments design;
  design.threads = run.threads;
  design.command_line = run.command_line;
  addDesign(app, design);
  addCompare(app, compare);
  addNoise(app, noise);
  addReport(app, report);
  addVerify(app, verify);
  addSchema(app);
  addVariables(app, variables);
  addCompletion(app, shell);
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongInput;
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2 && std::string(arguments[1]) == twinmap::fmi::kWorkerArgument) {
    twinmap::fmi::runWorker();  // a process of this program itself, which no user starts
  }
  cli::setUpLog();
  try {
    return runCommand(count, arguments);
  } catch (const twinmap::ExperimentError& error) {
    std::cerr << "twinmap: error: " << error.what() << "\n";
    return kWrongInput;
  } catch (const cli::GatesFailed& error) {
    std::cerr << "twinmap: error: " << error.what() << "\n";
    return kGatesFailed;
  } catch (const twinmap::Interrupted& interrupted) {
    std::cerr << "twinmap: " << interrupted.what() << "\n";
    return kInterrupted + cli::getSignal();
  } catch (const std::exception& error) {
    std::cerr << "twinmap: error: " << error.what() << "\n";
    return kFailed;
  }
}
