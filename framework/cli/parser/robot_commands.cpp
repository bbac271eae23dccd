#include <CLI/CLI.hpp>
#include <memory>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"

namespace twinmap::cli {

void addRobotCommands(CLI::App& app) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand("import", "Make an experiment file of a robot (URDF)");
  command->footer(
      "Prints the experiment file: bodies, joints, friction, mimic joints, a signal for the force of each "
      "joint. "
      "What it leaves out stands at its head and on stderr, with lines and what it would have done.");
  command->add_option("FILE", arguments->file, "URDF")->required()->option_text(" ");
  command->add_option("--base", arguments->base, "Of the first link: fixed or free (default: fixed)")
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
  command->add_flag("--stops", arguments->stops, "Rigid stops, without rebound, at the joints' limits");
  command->add_flag("--strict", arguments->strict, "Fail where anything is left out");
  command->callback([arguments] { importRobot(*arguments); });
}

}  // namespace twinmap::cli
