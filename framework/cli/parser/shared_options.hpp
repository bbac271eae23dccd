#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"

namespace twinmap::cli {

/// An option that takes a value, which the help calls `type`.
template <class T>
CLI::Option* addOption(CLI::App& command, const char* name, const char* type, T& value, const char* help) {
  return command.add_option(name, value, help)->type_name(type);
}

/// What stands on the command line by its place.
template <class T>
CLI::Option* addArgument(CLI::App& command, const char* name, T& value, const char* help) {
  return command.add_option(name, value, help)->required()->option_text(" ");
}

// Options that several commands take.

/// Of an option's value: a finite number above 0.
CLI::Validator makePositiveCheck();

/// FILE and its overrides.
void addExperiment(CLI::App& command, ExperimentArguments& arguments);

void addFailOnGates(CLI::App& command, bool& fail);

void addThreads(CLI::App& command, int& threads);

/// Values of known inputs: --set.
void addKnown(CLI::App& command, std::vector<std::string>& known);

/// What run, plan and submit take: FILE, --out, --store, --threads, --memory; and how they were called.
void addWhereAndHow(CLI::App& command, RunArguments& arguments, const Invocation& invocation);

/// Of a cluster: --time, --cpus, --shards.
void addJobs(CLI::App& command, SubmitArguments& arguments);

/// Which scheduler: --on.
CLI::Option* addOn(CLI::App& command, SubmitArguments& arguments);

/// --refine and --no-refine, which overrule what the experiment says.
void addRefine(CLI::App& command, std::optional<bool>& refine);

}  // namespace twinmap::cli
