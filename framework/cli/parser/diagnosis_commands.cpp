#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap::cli {
namespace {

void addStarts(CLI::App& command, std::vector<double>& starts) {
  addOption(command, "--start", "S", starts,
            "Time in the file (s) at which the model's time is 0; several are several windows");
}

/// Not in the help: says what to do instead, before anything is said to be missing.
void refuseTrials(CLI::App& command) {
  const auto refuse = [name = command.get_name()](const std::vector<std::string>& trials) {
    throw ExperimentError("--trial " + trials.front() + ": " + name +
                          " takes recordings of one experiment: " + describeOwnFile() +
                          ", and give it instead, with the trial's recordings");
  };
  command.add_option_function<std::vector<std::string>>("--trial", refuse)
      ->allow_extra_args(false)
      ->group("");
}

void addDiagnose(CLI::App& app) {
  const auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command = app.add_subcommand("diagnose", "Say what a model lacks to explain measurements");
  command->footer(
      "Tests friction, springs, masses, hysteresis, hidden modes, sensors and signals, and fits the best. "
      "Without measurements it prints which of them would go unnoticed.");
  addArgument(*command, "RUN", arguments->run,
              "Folder of a finished run, its maps.h5, or an experiment file (YAML)");
  command
      ->add_option("MEASUREMENT", arguments->files,
                   "Files of one machine, explained together: CSV, MATLAB or HDF5, as infer takes them")
      ->option_text(" ");
  addOption(*command, "--trial", "NAME=FILE", arguments->trials,
            "A recording of one of the experiment's trials, in the place of MEASUREMENT; all of them are "
            "explained together")
      ->allow_extra_args(false);
  addKnown(*command, arguments->known);
  addStarts(*command, arguments->starts);
  addOption(*command, "--accept", "TERM,...", arguments->accepted,
            "Take these terms, one after the other, instead of those that are found; see --out")
      ->delimiter(',')
      ->allow_extra_args(false);
  for (const auto& [name, terms, says] :
       {std::tuple("--only", &arguments->only,
                   "Look for these terms alone, or all of a name (friction of a bench: "
                   "coulomb,stribeck)"),
        std::tuple("--without", &arguments->without,
                   "Leave these out, which the machine cannot have (gain.voltage, clock)")}) {
    addOption(*command, name, "TERM,...", *terms, says)->delimiter(',')->allow_extra_args(false);
  }
  addOption(*command, "--out", "FILE", arguments->out, "File for the corrected experiment (YAML)");
  addOption(
      *command, "--page", "FILE", arguments->page,
      "File for a page (HTML) that draws the residuals and the unknown forces over speed, position and time");
  CLI::Option* csv = command->add_flag("--csv", arguments->csv, "Print CSV instead of a table");
  command->add_flag("--json", arguments->json, "Print a line of JSON")->excludes(csv);
  addThreads(*command, arguments->threads);
  command->callback([arguments] { diagnose(*arguments); });
}

void addValidate(CLI::App& app) {
  const auto arguments = std::make_shared<ValidateArguments>();
  CLI::App* command =
      app.add_subcommand("validate", "Predict measurements by parameters inferred from others");
  command->footer(
      "Holds the machine's parameters, fits what each recording leaves unknown besides, and compares the "
      "residual with the noise and with that of the nominal parameters. The exit status is 3 where a "
      "prediction fails.");
  addArgument(*command, "RUN", arguments->run,
              "Folder of a finished run, its maps.h5, or an experiment file (YAML)");
  addArgument(*command, "MEASUREMENT", arguments->files,
              "Files of one machine, to infer its parameters from (with --with, the size of unknown noise)")
      ->required(false);
  addOption(*command, "--with", "NAME=VALUE,...", arguments->stated,
            "Predict by these values of all parameters, as others state them: M=95.11,Fv=203.5")
      ->delimiter(',');
  addOption(*command, "--against", "FILE", arguments->against, "Files to predict")->required();
  addKnown(*command, arguments->known);
  addStarts(*command, arguments->starts);
  addOption(*command, "--against-start", "S", arguments->against_starts, "The same of the files to predict");
  addOption(*command, "--max-rms", "R", arguments->max_rms,
            "Pass up to this rms residual, in noise standard deviations (default: what noise and the "
            "parameters' sd leave in 99 % of predictions)")
      ->check(makePositiveCheck());
  command->add_flag("--json", arguments->json, "Print a line of JSON");
  refuseTrials(*command);
  addThreads(*command, arguments->threads);
  command->callback([arguments] { validate(*arguments); });
}

void addSelect(CLI::App& app) {
  const auto arguments = std::make_shared<SelectArguments>();
  CLI::App* command = app.add_subcommand("select", "Compare structures of a model by the same measurements");
  command->footer(
      "Prints the evidence of each experiment, relative to the best, and how well it predicts what it is not "
      "fitted to: each recording by the others, or the last third of a single one.");
  addArgument(*command, "FILE", arguments->files, "Experiment files (YAML), then files of measurements");
  addKnown(*command, arguments->known);
  addStarts(*command, arguments->starts);
  command->add_flag("--json", arguments->json, "Print a line of JSON");
  refuseTrials(*command);
  addThreads(*command, arguments->threads);
  command->callback([arguments] { select(*arguments); });
}

}  // namespace

void addDiagnosisCommands(CLI::App& app) {
  addDiagnose(app);
  addValidate(app);
  addSelect(app);
}

}  // namespace twinmap::cli
