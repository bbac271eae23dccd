#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace twinmap::cli {

/// What a command knows of how it was called.
struct Invocation {
  std::string line;  ///< as a shell would take it again
  int threads = 1;   ///< unless --threads says otherwise
};

// Each adds the commands of one kind to the parser. A command's arguments live as long as its parser.

/// check, simulate, run, plan, design.
void addExperimentCommands(CLI::App& app, const Invocation& invocation);

/// infer, replay, export, noise, look.
void addMapCommands(CLI::App& app, const Invocation& invocation);

/// track, serve.
void addTwinCommands(CLI::App& app);

/// import, view.
void addRobotCommands(CLI::App& app);

/// diagnose, validate, select.
void addDiagnosisCommands(CLI::App& app);

/// status, compare, report, verify, store.
void addResultCommands(CLI::App& app, const Invocation& invocation);

/// submit, shard, cancel.
void addClusterCommands(CLI::App& app, const Invocation& invocation);

/// explain, schema, variables, completion.
void addReferenceCommands(CLI::App& app);

}  // namespace twinmap::cli
