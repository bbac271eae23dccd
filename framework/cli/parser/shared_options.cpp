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
  command.add_option("FILE", arguments.file, "Experiment file (YAML)")->required()->option_text(" ");
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
  command
      .add_option("--threads", threads,
                  "Threads (default: all cores, or OMP_NUM_THREADS); results do not depend on them")
      ->type_name("N")
      ->check(CLI::Range(1, kMaxThreads));
}

void addWhereAndHow(CLI::App& command, RunArguments& arguments, const Invocation& invocation) {
  arguments.threads = invocation.threads;
  arguments.command_line = invocation.line;
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
      ->check(makePositiveCheck());
}

void addJobs(CLI::App& command, SubmitArguments& arguments) {
  constexpr int kLongest = 100000, kMaxCpus = 1024, kMaxShards = 1000;
  command.add_option("--time", arguments.minutes, "Time limit of a job; min (default: 60)")
      ->type_name("MINUTES")
      ->check(CLI::Range(1, kLongest));
  command.add_option("--cpus", arguments.cpus, "Threads of a job (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(1, kMaxCpus));
  command
      .add_option("--shards", arguments.shards,
                  "Jobs that simulate (default: such that each takes half of the time limit)")
      ->type_name("N")
      ->check(CLI::Range(1, kMaxShards));
}

CLI::Option* addOn(CLI::App& command, SubmitArguments& arguments) {
  return command.add_option("--on", arguments.on, "slurm, template or local")
      ->type_name("SCHEDULER")
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
