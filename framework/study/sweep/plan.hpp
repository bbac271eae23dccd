#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/log/stage_notes.hpp"
#include "framework/experiment/files/sweep_cases.hpp"
#include "framework/study/sweep/probe.hpp"
#include "framework/study/sweep/stored_counts.hpp"

namespace twinmap {

/// Where the results and the simulated samples of an experiment lie.
struct ResultPlace {
  std::filesystem::path folder;  ///< of the run; what is there already counts as done
  std::filesystem::path store;   ///< as given to the run
};

/// All that plans of an experiment are made of, looked at once.
struct ExperimentSurvey {
  std::vector<SweepCase> cases;  ///< one without a name where there is no sweep
  std::vector<bool> complete;    ///< one value a case
  std::filesystem::path folder;  ///< of the run
  StoredCounts stored;
  ProbeTimes times;  ///< of the case with the most work; none where all are complete
};

/// Looks at the cases of an experiment (expandCasesWithSignals), without times. Writes nothing. Cost
/// (bench/scale.py): some us a sample; 30 kB a case and 200 bytes a sample of memory.
ExperimentSurvey surveyCases(std::vector<SweepCase> cases, const ResultPlace& place);

/// Simulates and trains a little in a temporary folder (measureProbe) to find the times. Cost: 2 s on the two
/// beams, 10 s on ten outputs of 100000 samples.
void measureTimes(ExperimentSurvey& survey);

struct PlanOptions {
  int threads = 1;
  double memory = 4e9;  ///< bytes
};

/// What a run would do.
struct SweepPlan {
  int cases = 0;
  int complete = 0;
  StoredCounts stored;
  double simulate_s = 0.0;         ///< wall time of what is missing
  double cases_s = 0.0;            ///< wall time of the cases after that
  std::vector<StageTime> largest;  ///< of the case with the most work, on one thread
  double memory = 0.0;             ///< bytes at the peak
  double disk = 0.0;               ///< bytes to be written
  std::string no_times;            ///< why times are not known; empty if they are
  std::vector<std::string> warnings;
};

/// Plans a run of what was looked at.
SweepPlan planRun(const ExperimentSurvey& survey, const PlanOptions& options);

/// A line a fact.
std::string describePlan(const SweepPlan& plan, const PlanOptions& options);

/// Throws ExperimentError where a run would not fit: a case that is to be done into `most_memory` (bytes; a
/// run refuses it, too), or what is to be written on the disk of the run's folder.
void requireFit(const ExperimentSurvey& survey, const SweepPlan& plan, const PlanOptions& options,
                double most_memory);

}  // namespace twinmap
