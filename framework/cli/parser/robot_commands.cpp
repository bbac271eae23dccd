#include <CLI/CLI.hpp>
#include <memory>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"

namespace twinmap::cli {
namespace {

void addImport(CLI::App& app) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand("import", "Make an experiment file of a robot (URDF, MJCF)");
  command->footer(
      "Prints the experiment file: bodies, joints, friction, mimic joints, a signal for the force of each "
      "joint. "
      "What it leaves out stands at its head and on stderr, with lines and what it would have done.");
  command->add_option("FILE", arguments->file, "URDF, or MJCF, which Python's package mujoco compiles")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--base", arguments->base, "Of the first link of a URDF: fixed or free (default: fixed)")
      ->type_name("HOW")
      ->check(CLI::IsMember({"fixed", "free"}));
  command
      ->add_option("--parameters", arguments->parameters,
                   "What to estimate: inertia, friction, armature, damping; priors of 20 % about the file's "
                   "values (default: gravity alone)")
      ->type_name("KIND,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--joints", arguments->joints, "Joints that move; others stay at 0 (default: all move)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option(
          "--csv", arguments->csv,
          "Recording whose columns are called as coordinates (angles, in 'deg' too) and signals: they "
          "become the measurement and the excitation")
      ->type_name("FILE");
  command->add_flag("--stops", arguments->stops, "Rigid stops, without rebound, at the joints' limits");
  command->add_flag("--strict", arguments->strict, "Fail where anything is left out");
  command->callback([arguments] { importRobot(*arguments); });
}

void addView(CLI::App& app) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "Draw the mechanism, and let it move");
  command->footer(
      "Writes one page (HTML, three.js) that needs no network: bodies, joints with axes, springs, sensors, "
      "moving "
      "as the nominal model does and, with a measurement, the updated one; outputs over time. Without WebGL, "
      "and "
      "in print, it shows the picture.");
  command->add_option("FILE", arguments->experiment.file, "Experiment file, or folder of a finished run")
      ->required()
      ->option_text(" ");
  command
      ->add_option("MEASUREMENT", arguments->measurement,
                   "File that the updated model is inferred from, as infer takes it")
      ->option_text(" ");
  command->add_option("--start", arguments->start, "Time in the file (s) at which the model's time is 0")
      ->type_name("S");
  command->add_option("--set", arguments->known, "Value of a known input of the set-up; for each of them")
      ->type_name("NAME=VALUE");
  command->add_option("--out", arguments->out, "File for the page (default: the experiment's name)")
      ->type_name("FILE");
  command->add_option("--svg", arguments->svg, "File for a static picture instead, or beside --out")
      ->type_name("FILE");
  command->callback([arguments] { view(*arguments); });
}

}  // namespace

void addRobotCommands(CLI::App& app) {
  addImport(app);
  addView(app);
}

}  // namespace twinmap::cli
