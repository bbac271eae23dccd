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
  addOption(command, "--trial", "NAME=FILE", arguments.trials,
            "A recording of one of the experiment's trials; all of them are inferred together, several of "
            "one trial are repeats");
  command.add_flag(
      "--joint", arguments.joint,
      "Infer all files and --start together as recordings of one machine, and test whether they agree");
  addOption(command, "--windows", "S", arguments.windows,
            "Infer the windows of each file that begin every S seconds together, and test whether they agree")
      ->check(makePositiveCheck());
  addOption(command, "--segments", "S", arguments.segments,
            "Cut each file into segments of S seconds, each from an initial state of its own: for what is "
            "unstable or chaotic")
      ->check(makePositiveCheck());
}

void addPosterior(CLI::App& command, InferArguments& arguments) {
  CLI::Option* posterior =
      command.add_flag("--posterior{512}", arguments.posterior_draws,
                       "The posterior as well, without a normal approximation: quantiles, from so many draws "
                       "weighted by their likelihood on the simulator, or a surrogate's where that takes "
                       "long; --posterior=2000 for more than 512");
  addOption(command, "--posterior-from", "SOURCE", arguments.posterior_from,
            "What the posterior's likelihood is computed by: simulator or surrogate")
      ->check(CLI::IsMember({"simulator", "surrogate"}));
  addOption(command, "--draws", "FILE", arguments.draws, "File for the posterior's joint draws (CSV)")
      ->needs(posterior);
  addOption(command, "--profile", "FILE", arguments.profile,
            "File for the profile likelihood of each parameter on the simulator (CSV): it is held at 13 "
            "values, and the others are fitted anew");
}

void addInfer(CLI::App& app) {
  const auto arguments = std::make_shared<InferArguments>();
  CLI::App* command = app.add_subcommand("infer", "Estimate the parameters from measurements");
  command->footer(
      "With a run, the trained estimator gives the estimate, refined on the simulator where that is cheap. "
      "With an experiment file alone, the posterior is sampled on the simulator. Prints mean, sd and 95 % "
      "interval of each parameter, and whether the model fits.");
  addArgument(*command, "RUN", arguments->run,
              "Folder of a finished run, its maps.h5, or an experiment file (YAML): without a run the "
              "posterior is sampled on the simulator");
  command
      ->add_option("MEASUREMENT", arguments->files,
                   "Files: CSV, MATLAB .mat or HDF5, with a column of times and one for each output")
      ->option_text(" ");
  addKnown(*command, arguments->known);
  addOption(*command, "--start", "S", arguments->starts,
            "Time in the file (s) at which the model's time is 0; several infer several windows");
  addJointInference(*command, *arguments);
  CLI::Option* csv = command->add_flag("--csv", arguments->csv, "Print CSV instead of a table");
  command->add_flag("--json", arguments->json, "Print a line of JSON per measurement")->excludes(csv);
  command
      ->add_flag("--follow", arguments->follow,
                 "Read CSV measurements one after another from the standard input, each ended by an empty "
                 "line, and print a line of JSON for each at once")
      ->excludes(csv);
  addRefine(*command, arguments->refine);
  addPosterior(*command, *arguments);
  addOption(*command, "--page", "FILE", arguments->page,
            "File for a page (HTML): measured over fitted, residuals and their spectrum, estimates within "
            "their bounds; of several measurements the parameters over them");
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
  addArgument(*command, "RUN", arguments->run,
              "Folder of a finished run, its maps.h5, or an experiment file");
  addArgument(*command, "MEASUREMENT", arguments->file,
              "File: CSV, MATLAB .mat or HDF5, as infer takes them");
  addOption(*command, "--start", "S", arguments->start,
            "Time in the file (s) at which the model's time is 0");
  addOption(*command, "--from", "FILE", arguments->from,
            "Infer the parameters from this measurement instead (default: the same file)");
  addOption(*command, "--from-start", "S", arguments->from_start,
            "Where its window starts (default: as --start)");
  addKnown(*command, arguments->known);
  addRefine(*command, arguments->refine);
  addOption(*command, "--draws", "N", arguments->draws,
            "Simulations with parameters drawn from the estimate, for the band (default: 50)")
      ->check(CLI::Range(kMinDraws, kMaxDraws));
  addThreads(*command, arguments->threads);
  addOption(*command, "--out", "DIR", arguments->out,
            "Folder for the results (default: RUN/replay/NAME of the file)");
  command->callback([arguments] { replay(*arguments); });
}

void addRobotExport(CLI::App& command, RobotExportArguments& arguments) {
  CLI::Option* urdf =
      addOption(command, "--urdf,--mjcf", "FILE", arguments.robot,
                "URDF or MJCF that the experiment was imported from: written with what was estimated");
  addArgument(command, "MEASUREMENT", arguments.measurement,
              "Of --urdf and --mjcf: file to estimate from, as infer takes it")
      ->required(false);
  addOption(command, "--start", "S", arguments.start, "Time in the file (s) at which the model's time is 0")
      ->needs(urdf);
  addKnown(command, arguments.known);
  command.get_option("--set")->needs(urdf);
  addOption(command, "--out", "FILE", arguments.out,
            "File for the URDF or MJCF; values and sds go beside it, as JSON")
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
  addArgument(*command, "RUN", arguments->run,
              "Folder of a finished run; for a robot also an experiment file, or JSON of infer");
  addRobotExport(*command, *robot);
  addOption(*command, "--c", "DIR", arguments->c_folder,
            "Folder for C sources with a self-test and README.md");
  CLI::Option* fmu = command->add_option("--fmu", arguments->fmu, "File for an FMU for Co-Simulation");
  fmu->type_name("FILE");
  addOption(*command, "--fmi", "N", arguments->fmi, "Version of the FMU: 2 or 3 (default: 3)")
      ->check(CLI::IsMember({2, 3}))
      ->needs(fmu);
  addOption(*command, "--json", "FILE", arguments->json, "File for all numbers as JSON");
  command->add_flag("--float", arguments->single,
                    "C in float where that keeps what it says (default: double)");
  command->add_flag("--compress", arguments->compressed,
                    "C of processes with so few inducing inputs that at most 2 % of an sd is lost");
  command->add_flag_callback(
      "--no-trust", [arguments] { arguments->trust = false; }, "C without the trust status");
  addOption(*command, "--prefix", "NAME", arguments->prefix, "Of names and files in C (default: twinmap)");
  CLI::Option* track = command->add_flag(
      "--track", arguments->track,
      "In C and the FMU also a tracker, which follows the parameters from one measurement to the next as "
      "'twinmap track' does");
  addOption(*command, "--tracking", "FILE", arguments->tracking,
            "File with a section tracking for it (default: all parameters walk at unknown rates)")
      ->needs(track);
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
  addArgument(*command, "MEASUREMENT", arguments->measurement, "CSV, MATLAB or HDF5 file");
  addOption(*command, "--window", "A,B", arguments->window, "Times from A to B only; s (default: all)")
      ->delimiter(',')
      ->expected(2);
  addOption(*command, "--columns", "NAME,...", arguments->columns,
            "Columns, or outputs of the experiment (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  addOption(*command, "--experiment", "FILE", arguments->experiment,
            "Experiment file whose 'measurement' says where its outputs stand, and in which units");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments] { noise(*arguments); });
}

void addLook(CLI::App& app) {
  const auto arguments = std::make_shared<LookArguments>();
  CLI::App* command = app.add_subcommand("look", "Look at a recording before it is used");
  command->footer(
      "Prints of each column its unit, rate, range and noise, and what stands out: missing cells, gaps, "
      "jitter, spikes, clipping, angles that wrap.");
  addArgument(*command, "MEASUREMENT", arguments->measurement, "CSV, MATLAB or HDF5 file");
  CLI::Option* time = addOption(*command, "--time", "COLUMN", arguments->time,
                                "Column of times, such as 't [ms]' (default: t or time)");
  addOption(*command, "--rate", "HZ", arguments->sample_rate,
            "Rate of the rows instead of a column of times; Hz")
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
