#include "framework/result_files.hpp"

#include "framework/report/evaluation_tables.hpp"
#include "framework/report/html_report.hpp"
#include "framework/report/stddev_figure.hpp"
#include "framework/report/tables.hpp"
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
  writeTextFile(folder / "table.md", makeMarkdownTable(run));
  writeTextFile(folder / "table.tex", makeLatexTable(run));
  writeTextFile(folder / "report.html", makeHtmlReport(run));
  if (run.axes.empty()) {
    return;
  }
  fs::create_directories(folder / "figures");
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    writeTextFile(folder / "figures" / ("stddev_" + run.parameters[p].name.text + ".svg"),
                  makeStddevFigure(run, static_cast<int>(p)));
  }
}

void writeProvenance(const ExperimentSpec& experiment, const RunOptions& options, const RunSummary& run) {
  Provenance provenance{
      options.command, experiment.seed, options.threads, {}, static_cast<int>(run.failures.size())};
  provenance.reused_samples = run.reused_samples;
  for (const StageTime& time : run.times) {
    provenance.stage_seconds.emplace_back(time.stage, time.seconds);
  }
  writeTextFile(options.folder / "provenance.json", makeProvenanceJson(provenance));
}

}  // namespace twinmap
