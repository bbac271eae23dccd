#include "framework/results/result_files.hpp"

#include "framework/results/evaluation_tables.hpp"
#include "framework/results/tables.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/provenance.hpp"

namespace twinmap {

namespace fs = std::filesystem;

namespace {

void writeEvaluation(const fs::path& folder, const RunSummary& run) {
  if (run.relevance) {
    writeTextFile(folder / "features.csv", makeFeaturesCsv(run));
    writeTextFile(folder / "correlations.csv", makeCorrelationsCsv(run));
    writeTextFile(folder / "identifiability.csv", makeIdentifiabilityCsv(run));
  }
  if (!run.posteriors.empty()) {
    writeTextFile(folder / "posterior.csv", makePosteriorCsv(run));
  }
  if (!run.baselines.empty()) {
    writeTextFile(folder / "baselines.csv", makeBaselinesCsv(run));
  }
}

}  // namespace

void writeResults(const fs::path& folder, const RunSummary& run) {
  writeEvaluation(folder, run);
  writeTextFile(folder / "metrics.csv", makeMetricsCsv(run));
  writeTextFile(folder / "joint.csv", makeJointCsv(run));
  writeTextFile(folder / "pit.csv", makePitCsv(run));
  writeTextFile(folder / "predictions.csv", makePredictionsCsv(run));
  writeTextFile(folder / "training.csv", makeTrainingCsv(run));
  writeTextFile(folder / "hyperparameters.csv", makeHyperparametersCsv(run));
  writeTextFile(folder / "table.md", makeMarkdownTable(run));
  writeTextFile(folder / "table.tex", makeLatexTable(run));
}

void writeProvenance(const ExperimentSpec& experiment, const RunOptions& options, const RunSummary& run) {
  Provenance provenance;
  provenance.command = options.command;
  provenance.seed = experiment.seed;
  provenance.threads = options.threads;
  provenance.failed_samples = static_cast<int>(run.failures.size());
  provenance.reused_samples = run.reused_samples;
  provenance.online_updates = run.online.updates;
  provenance.online_median_us = run.online.median_us;
  provenance.online_p99_us = run.online.p99_us;
  provenance.warnings = run.warnings;
  for (const StageTime& time : run.times) {
    provenance.stage_seconds.emplace_back(time.stage, time.seconds);
  }
  provenance.digests = calcDigests(options.folder);
  writeTextFile(options.folder / "provenance.json", makeProvenanceJson(provenance));
}

}  // namespace twinmap
