#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "framework/cli/commands/commands.hpp"
#include "framework/cli/parser/command_groups.hpp"

namespace twinmap::cli {

// Options that several commands take.

/// Of an option's value: a finite number above 0.
CLI::Validator makePositiveCheck();

/// FILE and its overrides.
void addExperiment(CLI::App& command, ExperimentArguments& arguments);

void addFailOnGates(CLI::App& command, bool& fail);

void addThreads(CLI::App& command, int& threads);

/// What run, plan and submit take: FILE, --out, --store, --threads, --memory; and how they were called.
void addWhereAndHow(CLI::App& command, RunArguments& arguments, const Invocation& invocation);

/// Of a cluster: --time, --cpus, --shards.
void addJobs(CLI::App& command, SubmitArguments& arguments);

/// Which scheduler: --on.
CLI::Option* addOn(CLI::App& command, SubmitArguments& arguments);

/// --refine and --no-refine, which overrule what the experiment says.
void addRefine(CLI::App& command, std::optional<bool>& refine);

}  // namespace twinmap::cli
