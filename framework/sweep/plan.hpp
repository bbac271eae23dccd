#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/spec/yaml/yaml_node.hpp"
#include "framework/sweep/stored_counts.hpp"

namespace twinmap {

struct PlanOptions {
  std::filesystem::path folder;  ///< of the run; what is there already counts as done
  std::filesystem::path store;   ///< as given to the run
  int threads = 1;
  double memory = 4e9;  ///< bytes
};

/// What a run would do.
struct SweepPlan {
  int cases = 0;
  int complete = 0;
  StoredCounts stored;
  double simulate_s = 0.0;  ///< wall time of what is missing
  double cases_s = 0.0;     ///< wall time of the cases after that
  double memory = 0.0;      ///< bytes at the peak
  double disk = 0.0;        ///< bytes to be written
  std::string no_times;     ///< why times are not known; empty if they are
  std::vector<std::string> warnings;
};

/// Plans a run of an experiment's tree, with or without a sweep. Simulates and trains a little in a temporary
/// folder (measureProbe) to find the times; writes nothing else. Throws ExperimentError for a wrong
/// experiment.
SweepPlan planRun(const YamlNode& root, const PlanOptions& options);

/// For people, a line a fact.
std::string describePlan(const SweepPlan& plan, const PlanOptions& options);

}  // namespace twinmap
