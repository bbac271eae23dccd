#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/completion.hpp"
#include "framework/cli/parser/command_groups.hpp"

namespace twinmap::cli {
namespace {

void addVariables(CLI::App& app) {
  const auto file = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("variables", "Print the variables of an FMU");
  addArgument(*command, "FMU", *file, "File of FMI 2.0 or 3.0");
  command->callback([file] { printVariables(*file); });
}

void addExplain(CLI::App& app) {
  const auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command = app.add_subcommand("explain", "Explain a status or warning");
  command->add_option("NAME", arguments->name, "Status or warning, as model_mismatch; all without")
      ->option_text(" ");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments] { explain(*arguments); });
}

void addSchema(CLI::App& app) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON schema of experiment files, for editors");
  command->callback([] { printSchema(); });
}

Taken findTakenBy(const std::string& value) {
  constexpr std::array kFiles = {"FILE", "FMU", "MEASUREMENT", "OUT", "RUN"};
  constexpr std::array kFolders = {"DIR", "A", "B", "FROM"};
  const auto is_value = [&](const char* one) { return value == one; };
  return std::any_of(kFiles.begin(), kFiles.end(), is_value)       ? Taken::kFile
         : std::any_of(kFolders.begin(), kFolders.end(), is_value) ? Taken::kFolder
                                                                   : Taken::kOther;
}

OptionDescription describe(const CLI::Option& option) {
  if (option.get_positional()) {
    return {{option.get_name()}, option.get_description(), option.get_name(), findTakenBy(option.get_name())};
  }
  OptionDescription described;
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

std::vector<CommandDescription> describe(const CLI::App& app) {
  std::vector<CommandDescription> commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    CommandDescription described{command->get_name(), command->get_description(), {}, {}};
    for (const CLI::Option* option : command->get_options()) {
      (option->get_positional() ? described.arguments : described.options).push_back(describe(*option));
    }
    commands.push_back(described);
  }
  return commands;
}

void addCompletion(CLI::App& app) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print a script that completes command lines");
  command->footer("Source it, or install it where the shell looks for such scripts.");
  addArgument(*command, "SHELL", *shell, "bash, zsh or fish")->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([&app, shell] { std::cout << makeCompletion(*shell, describe(app)); });
}

}  // namespace

void addReferenceCommands(CLI::App& app) {
  addExplain(app);
  addSchema(app);
  addVariables(app);
  addCompletion(app);
}

}  // namespace twinmap::cli
