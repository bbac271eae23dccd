#pragma once

#include <string>

#include "framework/study/shards/scheduler.hpp"

namespace twinmap {

/// Cuts what is missing of an experiment into shards, takes the folder for it, and submits them. What shards
/// of an earlier submission left is kept, their failures are forgotten. Throws ExperimentError for a wrong
/// experiment or a folder with another one, std::runtime_error where jobs of the folder are queued, and as
/// submitJobs().
SubmittedJobs submitExperiment(const YamlNode& root, const ShardOptions& shards,
                               const SubmitOptions& options);

/// For people: shards, their time and memory.
std::string describeShards(const ShardPlan& plan, const ShardOptions& shards);

/// The commands of a plan stage by stage, for GNU parallel or a person.
std::string listCommands(const std::filesystem::path& folder, const ShardPlan& plan,
                         const std::string& program);

/// For people: how many shards are missing, running, done, and which failed and why. Empty where nothing was
/// submitted.
std::string describeSubmission(const std::filesystem::path& folder);

}  // namespace twinmap
