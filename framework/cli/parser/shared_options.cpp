#include "framework/cli/parser/shared_options.hpp"

#include <cmath>

namespace twinmap::cli {

CLI::Validator makePositiveCheck() {
  const auto check = [](const std::string& text) {
    double value = 0.0;
    const bool is_positive = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0;
    return is_positive ? std::string() : text + " is not a number above 0";
  };
  return CLI::Validator(check, "");
}

void addExperiment(CLI::App& command, ExperimentArguments& arguments) {
  addArgument(command, "FILE", arguments.file, "Experiment file (YAML)");
  command
      .add_option("key.path=value", arguments.overrides,
                  "Overrides of values in the file: noise.scale=2 'parameters.k_y.bounds=[4, 16]'; lists and "
                  "ranges sweep: design.train.samples=100,200 seed=1..10")
      ->option_text(" ");
}

void addFailOnGates(CLI::App& command, bool& fail) {
  command.add_flag("--fail-on-gates", fail, "Exit with 3 if one of the experiment's gates fails");
}

void addThreads(CLI::App& command, int& threads) {
  constexpr int kMaxThreads = 1024;
  addOption(command, "--threads", "N", threads,
            "Threads (default: all cores, or OMP_NUM_THREADS); results do not depend on them")
      ->check(CLI::Range(1, kMaxThreads));
}

void addKnown(CLI::App& command, std::vector<std::string>& known) {
  addOption(command, "--set", "NAME=VALUE", known, "Value of a known input of the set-up; for each of them");
}

void addWhereAndHow(CLI::App& command, RunArguments& arguments, const Invocation& invocation) {
  arguments.threads = invocation.threads;
  arguments.command_line = invocation.line;
  addExperiment(command, arguments.experiment);
  addOption(command, "--out", "DIR", arguments.folder, "Folder for the results (default: results/NAME)");
  addOption(command, "--store", "DIR", arguments.store,
            "Folder of simulated samples, shared with other runs (default: chunks in the run's folder)");
  addThreads(command, arguments.threads);
  addOption(command, "--memory", "GIB", arguments.memory,
            "Memory that the cases of a sweep may take together (default: half of the machine's)")
      ->check(makePositiveCheck());
}

void addJobs(CLI::App& command, SubmitArguments& arguments) {
  constexpr int kLongest = 100000, kMaxCpus = 1024, kMaxShards = 1000;
  addOption(command, "--time", "MINUTES", arguments.minutes, "Time limit of a job; min (default: 60)")
      ->check(CLI::Range(1, kLongest));
  addOption(command, "--cpus", "N", arguments.cpus, "Threads of a job (default: 1)")
      ->check(CLI::Range(1, kMaxCpus));
  addOption(command, "--shards", "N", arguments.shards,
            "Jobs that simulate (default: such that each takes half of the time limit)")
      ->check(CLI::Range(1, kMaxShards));
}

CLI::Option* addOn(CLI::App& command, SubmitArguments& arguments) {
  return addOption(command, "--on", "SCHEDULER", arguments.on, "slurm, template or local")
      ->check(CLI::IsMember({"slurm", "template", "local"}));
}

void addRefine(CLI::App& command, std::optional<bool>& refine) {
  CLI::Option* on = command.add_flag_callback(
      "--refine", [&refine] { refine = true; },
      "Refine the estimate by least squares on the simulator, accepted by a test (default: as the "
      "experiment's 'refine' says)");
  command
      .add_flag_callback(
          "--no-refine", [&refine] { refine = false; }, "Keep the quick estimate")
      ->excludes(on);
}

}  // namespace twinmap::cli
