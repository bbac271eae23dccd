#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "framework/base/text/number_text.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

/// Of --draws.
int readCount(const std::string& text) {
  constexpr int kMost = 100000;
  double count = 0.0;
  if (!parseLiteral(text, count) || count != std::floor(count) || count < 1 || count > kMost) {
    throw CLI::ValidationError("--draws", "must be a whole number from 1 to 100000, then a folder: " + text);
  }
  return static_cast<int>(count);
}

/// Recordings that are inferred together.
void addJointInference(CLI::App& command, InferArguments& arguments) {
  command
      .add_option("--trial", arguments.trials,
                  "A recording of one of the experiment's trials; all of them are inferred together, several "
                  "of one trial are repeats")
      ->type_name("NAME=FILE");
  command.add_flag("--joint", arguments.joint,
                   "Infer all files and --start together as recordings of one machine, and test whether they "
                   "agree");
  command
      .add_option("--windows", arguments.windows,
                  "Infer the windows of each file that begin every S seconds together, and test whether they "
                  "agree")
      ->type_name("S")
      ->check(makePositiveCheck());
  command
      .add_option(
          "--segments", arguments.segments,
          "Cut each file into segments of S seconds, each from an initial state of its own: for what is "
          "unstable or chaotic")
      ->type_name("S")
      ->check(makePositiveCheck());
}

void addPosterior(CLI::App& command, InferArguments& arguments) {
  CLI::Option* posterior = command.add_flag(
      "--posterior{512}", arguments.posterior_draws,
      "The posterior as well, without a normal approximation: quantiles, from so many draws weighted by "
      "their likelihood on the simulator, or a surrogate's where that takes long; --posterior=2000 for more "
      "than 512");
  command
      .add_option("--posterior-from", arguments.posterior_from,
                  "What the posterior's likelihood is computed by: simulator or surrogate")
      ->check(CLI::IsMember({"simulator", "surrogate"}))
      ->type_name("SOURCE");
  command.add_option("--draws", arguments.draws, "File for the posterior's joint draws (CSV)")
      ->type_name("FILE")
      ->needs(posterior);
  command
      .add_option(
          "--profile", arguments.profile,
          "File for the profile likelihood of each parameter on the simulator (CSV): it is held at 13 "
          "values, and the others are fitted anew")
      ->type_name("FILE");
}

void addInfer(CLI::App& app) {
  const auto arguments = std::make_shared<InferArguments>();
  CLI::App* command = app.add_subcommand("infer", "Estimate the parameters from measurements");
  command->footer(
      "With a run, the trained estimator gives the estimate, refined on the simulator where that is cheap. "
      "With an experiment file alone, the posterior is sampled on the simulator. Prints mean, sd and 95 % "
      "interval of each parameter, and whether the model fits.");
  command
      ->add_option("RUN", arguments->run,
                   "Folder of a finished run, its maps.h5, or an experiment file (YAML): without a run the "
                   "posterior is sampled on the simulator")
      ->required()
      ->option_text(" ");
  command
      ->add_option("MEASUREMENT", arguments->files,
                   "Files: CSV, MATLAB .mat or HDF5, with a column of times and one for each output")
      ->option_text(" ");
  command->add_option("--set", arguments->known, "Value of a known input of the set-up; for each of them")
      ->type_name("NAME=VALUE");
  command
      ->add_option("--start", arguments->starts,
                   "Time in the file (s) at which the model's time is 0; several infer several windows")
      ->type_name("S");
  addJointInference(*command, *arguments);
  CLI::Option* csv = command->add_flag("--csv", arguments->csv, "Print CSV instead of a table");
  command->add_flag("--json", arguments->json, "Print a line of JSON per measurement")->excludes(csv);
  command
      ->add_flag(
          "--follow", arguments->follow,
          "Read CSV measurements one after another from the standard input, each ended by an empty line, "
          "and print a line of JSON for each at once")
      ->excludes(csv);
  addRefine(*command, arguments->refine);
  addPosterior(*command, *arguments);
  command
      ->add_option(
          "--page", arguments->page,
          "File for a page (HTML): measured over fitted, residuals and their spectrum, estimates within "
          "their bounds; of several measurements the parameters over them")
      ->type_name("FILE");
  command
      ->add_flag("--diagnose", arguments->diagnose,
                 "Where the model does not fit, the whole table of what it may lack, as diagnose prints it")
      ->excludes(csv);
  addThreads(*command, arguments->threads);
  command->callback([arguments] { infer(*arguments); });
}

void addReplay(CLI::App& app, const Invocation& invocation) {
  const auto arguments = std::make_shared<ReplayArguments>();
  arguments->threads = invocation.threads;
  constexpr int kMinDraws = 2, kMaxDraws = 10000;
  CLI::App* command = app.add_subcommand("replay", "Simulate the updated model beside a measurement");
  command->footer(
      "Estimates the parameters, simulates the updated model, and writes tables and a page with the "
      "measured, nominal and updated responses and their residuals.");
  command->add_option("RUN", arguments->run, "Folder of a finished run, its maps.h5, or an experiment file")
      ->required()
      ->option_text(" ");
  command->add_option("MEASUREMENT", arguments->file, "File: CSV, MATLAB .mat or HDF5, as infer takes them")
      ->required()
      ->option_text(" ");
  command->add_option("--start", arguments->start, "Time in the file (s) at which the model's time is 0")
      ->type_name("S");
  command
      ->add_option("--from", arguments->from,
                   "Infer the parameters from this measurement instead (default: the same file)")
      ->type_name("FILE");
  command->add_option("--from-start", arguments->from_start, "Where its window starts (default: as --start)")
      ->type_name("S");
  command->add_option("--set", arguments->known, "Value of a known input of the set-up; for each of them")
      ->type_name("NAME=VALUE");
  addRefine(*command, arguments->refine);
  command
      ->add_option("--draws", arguments->draws,
                   "Simulations with parameters drawn from the estimate, for the band (default: 50)")
      ->type_name("N")
      ->check(CLI::Range(kMinDraws, kMaxDraws));
  addThreads(*command, arguments->threads);
  command
      ->add_option("--out", arguments->out, "Folder for the results (default: RUN/replay/NAME of the file)")
      ->type_name("DIR");
  command->callback([arguments] { replay(*arguments); });
}

void addRobotExport(CLI::App& command, RobotExportArguments& arguments) {
  CLI::Option* urdf = command.add_option(
      "--urdf,--mjcf", arguments.robot,
      "URDF or MJCF that the experiment was imported from: written with what was estimated");
  urdf->type_name("FILE");
  command
      .add_option("MEASUREMENT", arguments.measurement,
                  "Of --urdf and --mjcf: file to estimate from, as infer takes it")
      ->option_text(" ");
  command.add_option("--start", arguments.start, "Time in the file (s) at which the model's time is 0")
      ->type_name("S")
      ->needs(urdf);
  command.add_option("--set", arguments.known, "Value of a known input of the set-up; for each of them")
      ->type_name("NAME=VALUE")
      ->needs(urdf);
  command
      .add_option("--out", arguments.out, "File for the URDF or MJCF; values and sds go beside it, as JSON")
      ->type_name("FILE")
      ->needs(urdf);
  command.add_flag("--anyway", arguments.anyway, "Also of an estimate that is not ok")->needs(urdf);
  command
      .add_option_function<std::vector<std::string>>(
          "--draws",
          [&arguments](const std::vector<std::string>& values) {
            arguments.draws = readCount(values[0]);
            arguments.draws_folder = values[1];
          },
          "N files drawn from the estimate, in a folder, with their numbers as CSV")
      ->type_name("N DIR")
      ->expected(2)
      ->needs(urdf);
}

void addExport(CLI::App& app) {
  const auto arguments = std::make_shared<ExportArguments>();
  const auto robot = std::make_shared<RobotExportArguments>();
  CLI::App* command = app.add_subcommand(
      "export", "Write the trained estimator as C99, FMU or JSON, or what was estimated as URDF or MJCF");
  command
      ->add_option("RUN", arguments->run,
                   "Folder of a finished run; for a robot also an experiment file, or JSON of infer")
      ->required()
      ->option_text(" ");
  addRobotExport(*command, *robot);
  command->add_option("--c", arguments->c_folder, "Folder for C sources with a self-test and README.md")
      ->type_name("DIR");
  CLI::Option* fmu = command->add_option("--fmu", arguments->fmu, "File for an FMU for Co-Simulation");
  fmu->type_name("FILE");
  command->add_option("--fmi", arguments->fmi, "Version of the FMU: 2 or 3 (default: 3)")
      ->type_name("N")
      ->check(CLI::IsMember({2, 3}))
      ->needs(fmu);
  command->add_option("--json", arguments->json, "File for all numbers as JSON")->type_name("FILE");
  command->add_flag("--float", arguments->single,
                    "C in float where that keeps what it says (default: double)");
  command->add_flag("--compress", arguments->compressed,
                    "C of processes with so few inducing inputs that at most 2 % of an sd is lost");
  command->add_flag_callback(
      "--no-trust", [arguments] { arguments->trust = false; }, "C without the trust status");
  command->add_option("--prefix", arguments->prefix, "Of names and files in C (default: twinmap)")
      ->type_name("NAME");
  command->callback([arguments, robot] {
    robot->estimate = arguments->run;
    robot->robot.empty() ? exportMap(*arguments) : exportRobot(*robot);
  });
}

void addNoise(CLI::App& app) {
  const auto arguments = std::make_shared<NoiseArguments>();
  CLI::App* command = app.add_subcommand("noise", "Estimate the noise of a measurement");
  command->footer(
      "Takes a measurement while nothing moves, or residuals. Prints standard deviation and autoregressive "
      "model of each column, and the same as YAML for an experiment file.");
  command->add_option("MEASUREMENT", arguments->measurement, "CSV, MATLAB or HDF5 file")
      ->required()
      ->option_text(" ");
  command->add_option("--window", arguments->window, "Times from A to B only; s (default: all)")
      ->type_name("A,B")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--columns", arguments->columns, "Columns, or outputs of the experiment (default: all)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--experiment", arguments->experiment,
                   "Experiment file whose 'measurement' says where its outputs stand, and in which units")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments] { noise(*arguments); });
}

void addLook(CLI::App& app) {
  const auto arguments = std::make_shared<LookArguments>();
  CLI::App* command = app.add_subcommand("look", "Look at a recording before it is used");
  command->footer(
      "Prints of each column its unit, rate, range and noise, and what stands out: missing cells, gaps, "
      "jitter, "
      "spikes, clipping, angles that wrap.");
  command->add_option("MEASUREMENT", arguments->measurement, "CSV, MATLAB or HDF5 file")
      ->required()
      ->option_text(" ");
  CLI::Option* time =
      command->add_option("--time", arguments->time, "Column of times, such as 't [ms]' (default: t or time)")
          ->type_name("COLUMN");
  command->add_option("--rate", arguments->sample_rate, "Rate of the rows instead of a column of times; Hz")
      ->type_name("HZ")
      ->check(makePositiveCheck())
      ->excludes(time);
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments] { look(*arguments); });
}

}  // namespace

void addMapCommands(CLI::App& app, const Invocation& invocation) {
  addInfer(app);
  addReplay(app, invocation);
  addExport(app);
  addNoise(app);
  addLook(app);
}

}  // namespace twinmap::cli
