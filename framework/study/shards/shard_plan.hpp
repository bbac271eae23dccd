#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/experiment/files/sweep_cases.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/study/sweep/plan.hpp"

namespace twinmap {

/// What a shard does. The stages follow one another in this order.
enum class ShardKind {
  kSimulate,  ///< samples, and the stencils that derivatives at them take
  kCases,     ///< trains and evaluates
  kFinish,    ///< tables and report of the sweep
};

/// A part of an experiment's work that a job of a cluster does.
struct Shard {
  ShardKind kind = ShardKind::kSimulate;
  /// From `first` to before `last`: points in the order of collectShardPoints(), or cases.
  int first = 0, last = 0;
};

/// How long and wide shards may be.
struct ShardOptions {
  ResultPlace place;        ///< the folder's resolved.yaml becomes the experiment
  int threads = 1;          ///< of each shard
  double seconds = 1800.0;  ///< wanted duration of a shard: documents of clusters ask for 10 to 60 minutes
  int simulate_shards = 0;  ///< 0: by the measured cost of a sample
};

/// An experiment cut into shards; the same wherever it is read.
struct ShardPlan {
  std::filesystem::path store;     ///< absolute
  std::string computed_with;       ///< describeComputation(): shards refuse to compute with anything else
  bool portable = false;           ///< all cases are (simulation.portable): samples may be of any processor
  std::vector<Shard> shards;       ///< by their stages
  std::vector<int> train_samples;  ///< of each case: the most, where their number is automatic
  int missing = 0;                 ///< samples
  double simulate_s = 0.0;         ///< CPU time of all shards that simulate
  double cases_s = 0.0;            ///< and of the others
  double memory = 0.0;             ///< bytes of a shard

  int count(ShardKind kind) const;
};

/// Looks at the cases of an experiment's tree, with automatic numbers of samples limited as its jobs take
/// them.
ExperimentSurvey surveyForShards(const YamlNode& root, const ResultPlace& place);

/// Cuts what is missing of an experiment into shards by the costs that the survey measured; it must be of the
/// place in the options. At most 1000 a stage, as schedulers limit arrays.
ShardPlan makeShardPlan(const ExperimentSurvey& survey, const ShardOptions& options);

/// The cases of the plan's experiment, with its numbers of training samples.
std::vector<SweepCase> expandPlannedCases(const YamlNode& root, const ShardPlan& plan);

/// DIR/cluster/plan.json.
void writeShardPlan(const std::filesystem::path& folder, const ShardPlan& plan);
/// Throws ExperimentError if there is none.
ShardPlan readShardPlan(const std::filesystem::path& folder);

/// "simulate", "cases", "finish".
const char* getName(ShardKind kind);

/// DIR/cluster: plan, records, scripts and logs.
std::filesystem::path getClusterFolder(const std::filesystem::path& folder);

}  // namespace twinmap
