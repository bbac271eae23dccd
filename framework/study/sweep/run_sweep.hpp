#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "framework/base/log/run_control.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/results/gates.hpp"
#include "framework/study/sweep/sweep_folder.hpp"

namespace twinmap {

/// Where a sweep leaves what it finds, and what it may take.
struct SweepOptions {
  std::filesystem::path folder;  ///< created if missing
  std::filesystem::path store;   ///< where simulated samples are kept; empty: `folder`/chunks
  double memory = 4e9;           ///< bytes that responses, or cases that run at the same time, may take
  double most_memory = std::numeric_limits<double>::infinity();  ///< bytes that one case may take
  bool fail_fast = false;                                        ///< begin no case after one has failed
  std::string command;                                           ///< the command line, for provenance.json
};

struct SweepResult {
  int cases = 0;
  int complete = 0;  ///< now
  int skipped = 0;   ///< of them, those that were complete before
  std::vector<FailedCase> failures;
  bool stopped = false;  ///< by the flag, with something left
  std::string table;     ///< table.md
  std::vector<GateResult> gates;
};

/// Runs the cases of an experiment's tree with a sweep (docs/reference/files.md says what is left in the
/// folder): first all that is missing of the simulations, each point of a model once for all cases; then the
/// cases that are not complete. The results of a case are those of runExperiment() alone, bit for bit, for
/// any number of threads and however often the sweep was interrupted. Once `control`
/// stops it, the simulations and cases under way are finished and no other case is begun. A case that fails
/// is reported and stops no other, unless fail_fast. Throws ExperimentError for a wrong experiment or a case
/// that exceeds most_memory, before the folder is touched, and for a folder that holds another experiment;
/// std::runtime_error if a file cannot be written or another process has the folder or the store.
SweepResult runSweep(const YamlNode& root, const SweepOptions& options, const RunControl& control);

// The same in parts, of which several processes may do some at the same time; `keys` are listSweptKeys().

/// Takes the folder for the experiment: resolved.yaml and store.txt. Throws as runSweep().
void beginSweep(const YamlNode& root, const SweepOptions& options);

/// Of the automatic numbers of training samples, no more than their simulations' time allows, as measured
/// here: all cases' samples are simulated before the first case says how many it takes.
void limitAutomaticSamples(std::vector<SweepCase>& cases);

/// Runs those cases that are `wanted` and not complete, and simulates what they miss. Writes no tables.
SweepResult runCasesOfSweep(const std::vector<std::string>& keys, const std::vector<SweepCase>& cases,
                            const std::vector<bool>& wanted, const SweepOptions& options,
                            const RunControl& control);

/// Writes tables and report of the cases that are complete, and failed_cases.csv.
SweepResult finishSweep(const std::vector<std::string>& keys, const std::vector<SweepCase>& cases,
                        const std::vector<FailedCase>& failures, const SweepOptions& options,
                        const RunControl& control);

}  // namespace twinmap
