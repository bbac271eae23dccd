#pragma once

#include <filesystem>
#include <string>

#include "framework/base/log/run_control.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/results/run_summary.hpp"

namespace twinmap {

struct SampleSource;

/// Where a run leaves what it finds, and where its samples come from.
struct RunOptions {
  std::filesystem::path folder;  ///< created if missing; files of an earlier run are replaced one by one
  std::filesystem::path store;   ///< where simulated samples are kept; empty: `folder`/chunks
  std::string command;           ///< the command line, for provenance.json
  /// Where the number of training samples is automatic: so many, as another run chose; 0: to be chosen.
  int train_samples = 0;
  const SampleSource* samples = nullptr;  ///< shared with other runs of this process; null: the store
};

/// Runs an experiment from design to report. Samples that the store has are taken from it, so that an
/// interrupted run continues; the result is the same bit for bit. An automatic number of training samples is
/// chosen (chooseTrainingSamples), or that of the folder's samples.h5, where there is one. Leaves in the
/// folder: resolved.yaml, samples.h5, failures.csv, maps.h5 (not of a surrogate), predictions.csv,
/// metrics.csv, joint.csv, pit.csv, training.csv, table.md, table.tex, report.html, figures/*.csv,
/// provenance.json. Progress goes to the log. Throws Interrupted where `control` stops it; std::runtime_error
/// if more samples fail than simulation.allowed_failures permits (samples.h5 and failures.csv are there
/// then), if a map cannot be trained, if a file cannot be written, or if another process has the folder or
/// the store; ExperimentError if the folder holds the results of another experiment, whose differing keys it
/// names.
RunSummary runExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                         const RunControl& control);

/// Simulates the samples of an experiment and writes their points and noisy features to features.h5 of the
/// folder, in memory that does not grow with their number (writeFeatures()); trains nothing. An automatic
/// number of training samples is not chosen: throws ExperimentError. Otherwise throws as runExperiment()
/// does.
void runFeatures(const ExperimentSpec& experiment, const RunOptions& options, const RunControl& control);

}  // namespace twinmap
