#include "framework/report/sections/report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "framework/base/files/atomic_file.hpp"
#include "framework/report/mechanism.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/results/run_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// The chapters that show single test samples.
void addSampleChapters(const RunFolder& run, Page& page) {
  if (!run.predictions.empty()) {
    page.tables["samples"] = makeSamplesTable(run);
  }
  addParameters(run, page);
  addCurves(run, page);
  addInferred(run, page);
  addCalibration(run, page);
  addStddevOverBox(run, page);
}

void addModelChapters(const RunFolder& run, Page& page) {
  addFeatures(run, page);
  addTraining(run, page);
  addCost(run, page);
}

Report finish(const Page& page, std::vector<GateResult> gates) {
  Report report{makePage(page), {}, std::move(gates)};
  for (const auto& [name, table] : page.tables) {
    report.data.emplace_back(name, table.toCsv());
  }
  return report;
}

Report makeRunReport(const fs::path& folder) {
  const RunFolder run = readRunFolder(folder);
  const std::vector<GateResult> gates = checkGates(run.experiment.gates, run.metrics);
  Page page;
  page.title = run.experiment.name.text;
  addMechanism(run.experiment, "twinmap view RUN", page);
  addVerdict(run, gates, page);
  addResponses(run, page);
  addSampleChapters(run, page);
  addMetrics(run, page);
  addMethods(run, page);
  addComparedMaps(run, page);
  addModelChapters(run, page);
  return finish(page, gates);
}

/// The case with the smallest mean sd whose folder is there.
std::optional<RunFolder> readBestCase(const SweepFolder& sweep) {
  std::string best;
  double least = HUGE_VAL, sum = 0.0;
  for (std::size_t row = 0; row < sweep.table.rows.size(); ++row) {
    const std::string& name = sweep.table.getText(row, "case");
    const bool is_first = row == 0 || sweep.table.getText(row - 1, "case") != name;
    const bool is_last = row + 1 == sweep.table.rows.size() || sweep.table.getText(row + 1, "case") != name;
    sum = (is_first ? 0.0 : sum) + sweep.table.getNumber(row, "sd_pct");
    if (is_last && sum < least && fs::exists(sweep.path / "cases" / name / "resolved.yaml")) {
      least = sum;
      best = name;
    }
  }
  return best.empty() ? std::nullopt : std::optional<RunFolder>(readRunFolder(sweep.path / "cases" / best));
}

Report makeSweepReport(const fs::path& folder) {
  const SweepFolder sweep = readSweepFolder(folder);
  const std::optional<RunFolder> shown = readBestCase(sweep);
  std::vector<GateResult> gates;
  if (shown) {
    gates = checkGates(shown->experiment.gates, sweep.table);
  }
  Page page;
  page.title = sweep.label;
  addSweepVerdict(sweep, shown ? &*shown : nullptr, gates, page);
  if (!shown) {
    addSweep(sweep, page);
    return finish(page, gates);
  }
  addSweep(sweep, page);
  addResponses(*shown, page);
  addSampleChapters(*shown, page);
  addModelChapters(*shown, page);
  return finish(page, gates);
}

Report makeComparisonReport(const std::vector<fs::path>& folders) {
  std::vector<RunFolder> runs;
  for (const fs::path& folder : folders) {
    runs.push_back(readRunFolder(folder));
  }
  Page page;
  page.title = fmt::format("{} runs side by side", runs.size());
  addComparison(runs, page);
  return finish(page, {});
}

}  // namespace

Report makeReport(const std::vector<fs::path>& folders) {
  if (folders.size() > 1) {
    return makeComparisonReport(folders);
  }
  return isSweepFolder(folders.at(0)) ? makeSweepReport(folders[0]) : makeRunReport(folders[0]);
}

void writeReport(const fs::path& folder, const Report& report) {
  fs::create_directories(folder / "figures");
  for (const auto& [name, csv] : report.data) {
    writeTextFile(folder / "figures" / (name + ".csv"), csv);
  }
  writeTextFile(folder / "report.html", report.html);
}

}  // namespace twinmap
