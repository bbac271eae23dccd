#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <twinmap/build_info.hpp>
#include <utility>
#include <vector>

#include "framework/base/log/log.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"
#include "framework/cli/progress_line.hpp"
#include "framework/cli/signals.hpp"
#include "framework/models/fmu/worker.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace cli = twinmap::cli;

namespace {

constexpr int kFailed = 1;
constexpr int kWrongInput = 2;
constexpr int kGatesFailed = 3;
constexpr int kInterrupted = 128;  // plus the signal's number, as shells say it

/// The log goes to stderr, in colour on a terminal unless NO_COLOR is set.
void setUpLog() {
  const char* no_color = std::getenv("NO_COLOR");
  const bool plain = no_color != nullptr && no_color[0] != '\0';
  const std::string over_progress = cli::isTerminal() ? "\r\x1b[K" : "";
  twinmap::logToStderr(over_progress, !plain);
}

std::string joinArguments(int count, char** arguments) {
  std::string line = "twinmap";
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool plain = argument.find_first_of(" '\"[]{}$*?;&|<>()") == std::string::npos;
    line += plain ? " " + argument : " '" + argument + "'";
  }
  return line;
}

/// Headings of the help, in the order in which a user comes to them.
void groupCommands(CLI::App& app) {
  const std::pair<const char*, std::vector<const char*>> groups[] = {
      {"From a model to an estimate",
       {"import", "view", "check", "simulate", "run", "infer", "diagnose", "validate", "select", "replay"}},
      {"Keep a twin true", {"track", "serve"}},
      {"Improve the experiment", {"look", "noise", "design"}},
      {"Look after runs", {"plan", "status", "report", "compare", "verify", "store"}},
      {"Take the estimator elsewhere", {"export"}},
      {"On a cluster", {"submit", "shard", "cancel"}},
      {"Reference", {"explain", "schema", "variables", "completion"}}};
  for (const auto& [title, names] : groups) {
    for (const char* name : names) {
      app.get_subcommand(name)->group(title);
    }
  }
}

/// What is wrong with the command line, and where to look.
std::string describeParseError(const CLI::App* app, const CLI::Error& error) {
  const std::vector<CLI::App*> parsed = app->get_subcommands();
  const std::string command = parsed.empty() ? "" : " " + parsed.front()->get_name();
  return fmt::format("twinmap: error: {}\n  'twinmap{} --help' says what can be given.\n", error.what(),
                     command);
}

/// CLI11 says "A subcommand is required" of a misspelt one.
void throwIfUnknown(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
  }
  if (word.empty() || word.front() == '-' || std::find(names.begin(), names.end(), word) != names.end()) {
    return;
  }
  throw twinmap::ExperimentError(fmt::format("no command is called '{}'{}; 'twinmap --help' lists them", word,
                                             twinmap::suggestName(word, names)));
}

int runCommand(int count, char** arguments) {
  CLI::App app(
      "twinmap estimates the physical parameters of a simulation model from measured responses, with "
      "calibrated uncertainty.");
  app.name("twinmap");  // in the help, wherever the program lies
  app.set_version_flag("--version", std::string("twinmap ") + twinmap::kVersion);
  app.require_subcommand(1);
  const cli::Invocation invocation{joinArguments(count, arguments), twinmap::countThreads()};
  cli::addExperimentCommands(app, invocation);
  cli::addMapCommands(app, invocation);
  cli::addTwinCommands(app);
  cli::addRobotCommands(app);
  cli::addDiagnosisCommands(app);
  cli::addResultCommands(app, invocation);
  cli::addClusterCommands(app, invocation);
  cli::addReferenceCommands(app);
  groupCommands(app);
  app.footer(
      "A first twin, in four commands:\n"
      "  twinmap check experiments/duffing/cart.yaml\n"
      "  twinmap run experiments/duffing/cart.yaml\n"
      "  twinmap simulate experiments/duffing/cart.yaml --noise --csv cart.csv parameters.k=95\n"
      "  twinmap infer results/duffing_cart cart.csv\n\n"
      "twinmap COMMAND --help says what a command takes.");
  if (count == 1) {
    std::cerr << app.help();
    return kWrongInput;
  }
  throwIfUnknown(app, arguments[1]);
  app.failure_message(describeParseError);
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongInput;
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2 && std::string(arguments[1]) == twinmap::fmi::kWorkerArgument) {
    twinmap::fmi::runWorker();  // a process of this program itself, which no user starts
  }
  setUpLog();
  try {
    return runCommand(count, arguments);
  } catch (const twinmap::ExperimentError& error) {
    std::cerr << "twinmap: error: " << error.what() << "\n";
    return kWrongInput;
  } catch (const cli::GatesFailed& error) {
    std::cerr << "twinmap: error: " << error.what() << "\n";
    return kGatesFailed;
  } catch (const twinmap::Interrupted& interrupted) {
    std::cerr << "twinmap: " << interrupted.what() << "\n";
    return kInterrupted + cli::getSignal();
  } catch (const std::exception& error) {
    std::cerr << "twinmap: error: " << error.what() << "\n";
    return kFailed;
  }
}
