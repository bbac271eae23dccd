#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/verdict.hpp"

namespace twinmap {
namespace {

constexpr int kCostDigits = 3;

double calcSimulationSeconds(const ProvenanceRecord& provenance) {
  double sum = 0.0;
  for (const auto& [stage, time] : provenance.seconds) {
    const bool is_set = stage.rfind("simulate ", 0) == 0 && stage.find(" samples") != std::string::npos;
    sum += is_set ? time : 0.0;
  }
  return sum;
}

std::string makeDuration(double microseconds) {
  constexpr double kMillisecond = 1e3;
  return microseconds < kMillisecond ? toShortText(microseconds, kCostDigits) + " \u00b5s"
                                     : toShortText(microseconds / kMillisecond, kCostDigits) + " ms";
}

/// Empty where nothing was simulated in this run.
std::string describeSpeed(const RunFolder& run) {
  const double reused = run.provenance.getNumber("reused_samples");
  const double samples = run.experiment.design.train.samples + run.experiment.design.test.samples -
                         (std::isfinite(reused) ? reused : 0.0);
  const double simulating = calcSimulationSeconds(run.provenance);
  return simulating > 0.0 && samples > 0.0 ? fmt::format("{:.0f}", samples / simulating) : "";
}

std::string makeCostFacts(const RunFolder& run) {
  const ProvenanceRecord& provenance = run.provenance;
  std::vector<std::pair<std::string, std::string>> facts;
  if (const std::string speed = describeSpeed(run); !speed.empty()) {
    facts.emplace_back("simulations per second", speed);
  }
  if (const double median = provenance.getNumber("online: median_us"); std::isfinite(median)) {
    facts.emplace_back("one online update, median", makeDuration(median));
    facts.emplace_back("one online update, 99 % below", makeDuration(provenance.getNumber("online: p99_us")));
  }
  if (const double memory = provenance.getNumber("peak_memory_mb"); std::isfinite(memory)) {
    facts.emplace_back("peak memory", toShortText(memory, kCostDigits) + " MB");
  }
  if (const std::string* threads = provenance.find("threads")) {
    facts.emplace_back("threads", *threads);
  }
  return facts.empty() ? "" : makeFacts(facts);
}

void addStages(const RunFolder& run, Section& section, Page& page) {
  if (run.provenance.seconds.empty()) {
    return;
  }
  std::vector<std::string> stages;
  std::vector<double> times;
  for (const auto& [stage, time] : run.provenance.seconds) {
    stages.push_back(stage);
    times.push_back(time);
  }
  constexpr double kRoomForNumbers = 1.4;
  const double longest = *std::max_element(times.begin(), times.end());
  const double end = kRoomForNumbers * std::max(longest, 1e-6);
  const double height = calcHeatHeight(stages.size());
  DataTable table;
  table.add("stage", std::move(stages));
  table.add("seconds", std::move(times));
  page.tables["stages"] = std::move(table);
  addFigure({"stages",
             "Time per stage",
             "Wall time of each stage of the run, in its order.",
             "stages",
             {{"stages", {}, {{"height", height}, {"end", end}}}},
             {},
             1},
            section);
}

std::string makeProvenanceTable(const ProvenanceRecord& provenance) {
  std::vector<std::vector<HtmlCell>> rows;
  for (const auto& [key, value] : provenance.entries) {
    if (key != "command") {
      rows.push_back({makeTextCell(key), makeTextCell(value)});
    }
  }
  return makeHtmlTable("provenance", "As in provenance.json.", {"what", "value"}, rows);
}

void addProvenance(const RunFolder& run, Section& section) {
  section.html += makeElement("h3", "Provenance") + "\n";
  section.html +=
      makeParagraph("To repeat this run, bit for bit on the same type of machine, in its folder:");
  section.html += makeElement("pre", makeElement("code", "twinmap run resolved.yaml")) + "\n";
  if (const std::string* command = run.provenance.find("command")) {
    section.html += makeParagraph("It was made by:") +
                    makeElement("pre", makeElement("code", escapeHtml(*command))) + "\n";
  }
  if (!run.provenance.entries.empty()) {
    section.html += makeProvenanceTable(run.provenance);
  }
}

/// What the trust model would find.
void addTrustPower(const RunFolder& run, Section& section) {
  const CsvTable& power = run.trust_power;
  if (power.rows.empty()) {
    return;
  }
  CsvTable shown{{"kind", "name", "smallest_change", "unit"}, {}};
  for (std::size_t row = 0; row < power.rows.size(); ++row) {
    const std::string& kind = power.getText(row, "kind");
    shown.rows.push_back({kind, power.getText(row, "name"), power.getText(row, "smallest_change"),
                          kind == "constant" ? "of its value" : power.getText(row, "unit")});
  }
  section.html +=
      makeElement("h3", "What the trust status would find") +
      makeHtmlTable(
          "trust-power",
          "The smallest change of a constant, and the smallest constant offset of an output, that "
          "95 % of the measurements are called a model_mismatch for; a dash where none is found.",
          shown,
          {{"kind", "kind"}, {"name", "name"}, {"smallest_change", "smallest change", 2}, {"unit", "unit"}});
}

}  // namespace

void addCost(const RunFolder& run, Page& page) {
  Section section{"cost", "Cost, failures, provenance", "", {}};
  section.html = makeCostFacts(run);
  addStages(run, section, page);
  addTrustPower(run, section);
  addFailures(run, section, page);
  addProvenance(run, section);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
