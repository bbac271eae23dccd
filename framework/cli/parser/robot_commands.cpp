#include <CLI/CLI.hpp>
#include <memory>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

void addImport(CLI::App& app) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand("import", "Make an experiment file of a robot (URDF, MJCF)");
  command->footer(
      "Prints the experiment file: bodies, joints, friction, mimic joints, a signal for the force of each "
      "joint. What it leaves out stands at its head and on stderr, with lines and what it would have done.");
  addArgument(*command, "FILE", arguments->file, "URDF, or MJCF, which Python's package mujoco compiles");
  addOption(*command, "--base", "HOW", arguments->base,
            "Of the first link of a URDF: fixed or free (default: fixed)")
      ->check(CLI::IsMember({"fixed", "free"}));
  addOption(*command, "--parameters", "KIND,...", arguments->parameters,
            "What to estimate: inertia, friction, armature, damping; priors of 20 % about the file's values "
            "(default: gravity alone)")
      ->delimiter(',')
      ->allow_extra_args(false);
  addOption(*command, "--joints", "NAME,...", arguments->joints,
            "Joints that move; others stay at 0 (default: all move)")
      ->delimiter(',')
      ->allow_extra_args(false);
  addOption(*command, "--csv", "FILE", arguments->csv,
            "Recording whose columns are called as coordinates (angles, in 'deg' too) and signals: they "
            "become the measurement and the excitation");
  CLI::Option* from_motion =
      command->add_flag("--from-motion", arguments->from_motion,
                        "The joints move as recorded, and the forces of their drives are measured (inverse "
                        "dynamics), in place of the motion that forces cause");
  command->add_flag("--stops", arguments->stops, "Rigid stops, without rebound, at the joints' limits")
      ->excludes(from_motion);
  command->add_flag("--strict", arguments->strict, "Fail where anything is left out");
  command->callback([arguments] { importRobot(*arguments); });
}

void addView(CLI::App& app) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "Draw the mechanism, and let it move");
  command->footer(
      "Writes one page (HTML, three.js) that needs no network: bodies, joints with axes, springs, sensors, "
      "moving as the nominal model does and, with a measurement, the updated one and what was measured, "
      "residuals as colour; modes; outputs over time. Without WebGL, and in print, it shows the picture.");
  addArgument(*command, "FILE", arguments->experiment.file, "Experiment file, or folder of a finished run");
  addArgument(*command, "MEASUREMENT", arguments->measurement,
              "File that the updated model is inferred from, as infer takes it")
      ->required(false);
  addOption(*command, "--start", "S", arguments->start,
            "Time in the file (s) at which the model's time is 0");
  addKnown(*command, arguments->known);
  addOption(*command, "--out", "FILE", arguments->out, "File for the page (default: the experiment's name)");
  addOption(*command, "--svg", "FILE", arguments->svg, "File for a static picture instead, or beside --out");
  addOption(*command, "--mp4", "FILE", arguments->mp4,
            "File for a film instead, or beside: all motions overlaid, by ffmpeg");
  command->callback([arguments] { view(*arguments); });
}

}  // namespace

void addRobotCommands(CLI::App& app) {
  addImport(app);
  addView(app);
}

}  // namespace twinmap::cli
