#include "framework/results/result_files.hpp"

#include "framework/base/files/atomic_file.hpp"
#include "framework/results/evaluation_tables.hpp"
#include "framework/results/tables.hpp"
#include "framework/results/warnings.hpp"

namespace twinmap {

namespace fs = std::filesystem;

namespace {

void writeEvaluation(const fs::path& folder, const RunSummary& run) {
  if (run.evaluation.relevance) {
    writeTextFile(folder / "features.csv", makeFeaturesCsv(run));
    writeTextFile(folder / "correlations.csv", makeCorrelationsCsv(run));
    writeTextFile(folder / "identifiability.csv", makeIdentifiabilityCsv(run));
  }
  if (!run.evaluation.ridges.empty()) {
    writeTextFile(folder / "identified.csv", makeIdentifiedCsv(run));
  }
  if (run.evaluation.derived) {
    writeTextFile(folder / "derived.csv", makeDerivedCsv(run));
  }
  if (!run.evaluation.curves.curves.empty()) {
    writeTextFile(folder / "curves.csv", makeCurvesCsv(run));
  }
  if (!run.evaluation.posteriors.empty()) {
    writeTextFile(folder / "posterior.csv", makePosteriorCsv(run));
  }
  if (run.evaluation.calibration) {
    writeTextFile(folder / "sbc.csv", makeSbcCsv(run));
  }
  if (!run.evaluation.baselines.empty()) {
    writeTextFile(folder / "baselines.csv", makeBaselinesCsv(run));
  }
  if (!run.evaluation.maps.empty()) {
    writeTextFile(folder / "maps.csv", makeMapsCsv(run));
  }
  if (!run.evaluation.methods.empty()) {
    writeTextFile(folder / "methods.csv", makeMethodsCsv(run));
    writeTextFile(folder / "refined.csv", makeRefinedCsv(run));
  }
}

}  // namespace

void writeResults(const fs::path& folder, const RunSummary& run) {
  writeEvaluation(folder, run);
  writeTextFile(folder / "metrics.csv", makeMetricsCsv(run));
  writeTextFile(folder / "joint.csv", makeJointCsv(run));
  writeTextFile(folder / "pit.csv", makePitCsv(run));
  writeTextFile(folder / "predictions.csv", makePredictionsCsv(run));
  if (!run.evaluation.predictions.mixtures.empty()) {
    writeTextFile(folder / "components.csv", makeComponentsCsv(run));
  }
  writeTextFile(folder / "training.csv", makeTrainingCsv(run));
  writeTextFile(folder / "hyperparameters.csv", makeHyperparametersCsv(run));
  if (run.training.cross_validation) {
    writeTextFile(folder / "cross_validation.csv", makeCrossValidationCsv(run));
  }
  if (run.training.chains) {
    writeTextFile(folder / "chains.csv", makeChainsCsv(*run.training.chains));
  }
  writeTextFile(folder / "table.md", makeMarkdownTable(run));
  writeTextFile(folder / "table.tex", makeLatexTable(run));
}

void writeProvenance(const fs::path& folder, Provenance provenance, const RunSummary& run) {
  provenance.failed_samples = static_cast<int>(run.failures.size());
  provenance.reused_samples = run.reused_samples;
  provenance.online_updates = run.online.updates;
  provenance.online_median_us = run.online.median_us;
  provenance.online_p99_us = run.online.p99_us;
  provenance.warnings = collectWarnings(run);
  for (const StageTime& time : run.notes.times) {
    provenance.stage_seconds.emplace_back(time.stage, time.seconds);
  }
  provenance.digests = calcDigests(folder);
  writeTextFile(folder / "provenance.json", makeProvenanceJson(provenance));
}

}  // namespace twinmap
