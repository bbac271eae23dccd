#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/parser/shared_options.hpp"

namespace twinmap::cli {
namespace {

/// What an option or an argument takes, as shells complete it.
enum class Taken { kNothing, kFile, kFolder, kOther };

struct OptionDescription {
  std::vector<std::string> names;  ///< "--out", with their dashes
  std::string description;
  std::string value;  ///< "DIR"; empty for a flag
  Taken taken = Taken::kNothing;
};

struct CommandDescription {
  std::string name;
  std::string description;
  std::vector<OptionDescription> options;
  std::vector<OptionDescription> arguments;  ///< by position; names: one, "FILE"
};

using Commands = std::vector<CommandDescription>;

/// Its first clause: a line beside others.
std::string makeSummary(const std::string& description) {
  std::size_t end = description.size();
  for (const char* mark : {". ", "; ", ": ", " (", "\n"}) {
    end = std::min(end, description.find(mark));
  }
  return description.substr(0, end);
}

/// For a word between single quotes; `special` is escaped by a backslash as well.
std::string quote(const std::string& text, const std::string& special = {}) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
      continue;
    }
    if (special.find(c) != std::string::npos) {
      quoted += '\\';
    }
    quoted += c;
  }
  return quoted;
}

std::string listNames(const CommandDescription& command) {
  std::string names;
  for (const OptionDescription& option : command.options) {
    for (const std::string& name : option.names) {
      names += (names.empty() ? "" : " ") + name;
    }
  }
  return names;
}

std::string listCommands(const Commands& commands) {
  std::string names;
  for (const CommandDescription& command : commands) {
    names += command.name + " ";
  }
  return names + "--help --version";
}

/// What the arguments that are no options are; files where some are.
Taken findTaken(const CommandDescription& command) {
  Taken taken = Taken::kNothing;
  for (const OptionDescription& argument : command.arguments) {
    if (argument.taken == Taken::kFile || taken == Taken::kNothing) {
      taken = argument.taken;
    }
  }
  return taken;
}

const char* getBashAction(Taken taken) {
  return taken == Taken::kFile ? "_twinmap_take f" : taken == Taken::kFolder ? "_twinmap_take d" : ":";
}

std::string makeBash(const Commands& commands) {
  std::string values, names, arguments;
  for (const CommandDescription& command : commands) {
    for (const OptionDescription& option : command.options) {
      for (const std::string& name : option.names) {
        if (option.taken != Taken::kNothing) {
          values +=
              fmt::format("    '{} {}') {}; return ;;\n", command.name, name, getBashAction(option.taken));
        }
      }
    }
    names += fmt::format("      {}) _twinmap_words '{}' ;;\n", command.name, listNames(command));
    arguments += fmt::format("      {}) {} ;;\n", command.name, getBashAction(findTaken(command)));
  }
  return fmt::format(R"(# Completion of twinmap for bash; written by: twinmap completion bash
_twinmap_take() {{  # f: files and folders, d: folders
  compopt -o filenames
  mapfile -t COMPREPLY < <(compgen "-$1" -- "$current")
}}
_twinmap_words() {{
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}}
_twinmap() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    _twinmap_words '{}'
    return
  fi
  case "${{COMP_WORDS[1]}} $previous" in
{}  esac
  if [[ $current == -* ]]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  else
    case ${{COMP_WORDS[1]}} in
{}    esac
  fi
}}
complete -F _twinmap twinmap
)",
                     listCommands(commands), values, names, arguments);
}

const char* getZshAction(Taken taken) {
  return taken == Taken::kFile ? "_files" : taken == Taken::kFolder ? "_files -/" : " ";
}

std::string makeZsh(const Commands& commands) {
  std::string names, cases;
  for (const CommandDescription& command : commands) {
    names += fmt::format("    '{}:{}'\n", command.name, quote(makeSummary(command.description), ":"));
    cases += fmt::format("    {}) _arguments", command.name);
    for (const OptionDescription& option : command.options) {
      for (const std::string& name : option.names) {
        cases += fmt::format(" \\\n      '{}[{}]{}'", name, quote(makeSummary(option.description), "[]"),
                             option.taken == Taken::kNothing ? ""
                                                             : fmt::format(":{}:{}", quote(option.value, ":"),
                                                                           getZshAction(option.taken)));
      }
    }
    for (const OptionDescription& argument : command.arguments) {
      cases += fmt::format(" \\\n      '*:{}:{}'", argument.names.front(), getZshAction(findTaken(command)));
      break;
    }
    cases += " ;;\n";
  }
  return fmt::format(R"(#compdef twinmap
# Completion of twinmap for zsh; written by: twinmap completion zsh
_twinmap() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{}  esac
}}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _twinmap "$@"; else compdef _twinmap twinmap; fi
)",
                     names, cases);
}

std::string makeFish(const Commands& commands) {
  std::string script =
      "# Completion of twinmap for fish; written by: twinmap completion fish\n"
      "complete -c twinmap -f\n"
      "complete -c twinmap -n __fish_use_subcommand -l help -d 'Print the help'\n"
      "complete -c twinmap -n __fish_use_subcommand -l version -d 'Print the version'\n";
  for (const CommandDescription& command : commands) {
    script += fmt::format("complete -c twinmap -n __fish_use_subcommand -a {} -d '{}'\n", command.name,
                          quote(makeSummary(command.description)));
    const std::string here =
        fmt::format("complete -c twinmap -n '__fish_seen_subcommand_from {}'", command.name);
    for (const OptionDescription& option : command.options) {
      for (const std::string& name : option.names) {
        const bool is_long = name.rfind("--", 0) == 0;
        script += fmt::format("{} {} {} -d '{}'{}\n", here, is_long ? "-l" : "-s",
                              name.substr(is_long ? 2 : 1), quote(makeSummary(option.description)),
                              option.taken == Taken::kNothing  ? ""
                              : option.taken == Taken::kFile   ? " -r -F"
                              : option.taken == Taken::kFolder ? " -x -a '(__fish_complete_directories)'"
                                                               : " -x");
      }
    }
    const Taken taken = findTaken(command);
    if (taken == Taken::kFile) {
      script += here + " -F\n";
    } else if (taken == Taken::kFolder) {
      script += here + " -a '(__fish_complete_directories)'\n";
    }
  }
  return script;
}

/// A script that completes the command line of `twinmap`: its commands, their options, files and folders.
/// shell: "bash", "zsh" or "fish". Throws std::invalid_argument for another.
std::string makeCompletion(const std::string& shell, const Commands& commands) {
  if (shell == "bash") {
    return makeBash(commands);
  }
  if (shell == "zsh") {
    return makeZsh(commands);
  }
  if (shell == "fish") {
    return makeFish(commands);
  }
  throw std::invalid_argument("no completion for the shell '" + shell + "': bash, zsh or fish");
}

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
