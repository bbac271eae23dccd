#include <algorithm>
#include <cmath>

#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/verdict.hpp"
#include "framework/report/vega.hpp"
#include "framework/spec/yaml/number_text.hpp"

namespace twinmap {
namespace {

constexpr int kDigits = 3;

const Json* findRecord(const RunFolder& run, const char* key) {
  const bool found = run.provenance.is_object() && run.provenance.contains(key);
  return found ? &run.provenance[key] : nullptr;
}

std::string toPlainText(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

double calcSimulationSeconds(const Json& seconds) {
  double sum = 0.0;
  for (const auto& [stage, time] : seconds.items()) {
    const bool is_set = stage.rfind("simulate ", 0) == 0 && stage.find(" samples") != std::string::npos;
    sum += is_set ? time.get<double>() : 0.0;
  }
  return sum;
}

std::string makeDuration(double microseconds) {
  constexpr double kMillisecond = 1e3;
  return microseconds < kMillisecond ? toShortText(microseconds, kDigits) + " \u00b5s"
                                     : toShortText(microseconds / kMillisecond, kDigits) + " ms";
}

std::string makeCostFacts(const RunFolder& run) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (const Json* seconds = findRecord(run, "seconds")) {
    const double simulating = calcSimulationSeconds(*seconds);
    const Json* reused = findRecord(run, "reused_samples");
    const int samples = run.experiment.design.train.samples + run.experiment.design.test.samples -
                        (reused == nullptr ? 0 : reused->get<int>());
    if (simulating > 0.0 && samples > 0) {
      facts.emplace_back("simulations per second", toShortText(samples / simulating, kDigits));
    }
  }
  if (const Json* online = findRecord(run, "online")) {
    facts.emplace_back("one online update, median", makeDuration(online->value("median_us", NAN)));
    facts.emplace_back("one online update, 99 % below", makeDuration(online->value("p99_us", NAN)));
  }
  if (const Json* memory = findRecord(run, "peak_memory_mb")) {
    facts.emplace_back("peak memory", toShortText(memory->get<double>(), kDigits) + " MB");
  }
  if (const Json* threads = findRecord(run, "threads")) {
    facts.emplace_back("threads", toPlainText(*threads));
  }
  return facts.empty() ? "" : makeFacts(facts);
}

void addStages(const RunFolder& run, Section& section, Page& page) {
  const Json* seconds = findRecord(run, "seconds");
  if (seconds == nullptr || seconds->empty()) {
    return;
  }
  constexpr int kRowHeight = 26, kFrame = 10;
  std::vector<std::string> stages;
  std::vector<double> times;
  for (const auto& [stage, time] : seconds->items()) {
    stages.push_back(stage);
    times.push_back(time.get<double>());
  }
  Json spec = makePanelSpec("stages", kFrame + kRowHeight * static_cast<int>(stages.size()));
  spec.erase("params");
  constexpr double kRoomForNumbers = 1.4;
  const double longest = *std::max_element(times.begin(), times.end());
  const Json x = makeQuantitative("seconds", "wall time [s]",
                                  makeDomain(0.0, kRoomForNumbers * std::max(longest, 1e-6)));
  spec["encoding"] = {{"y", makeNominal("stage", "", {{"sort", nullptr}, {"axis", {{"labelLimit", 220}}}})},
                      {"x", x}};
  spec["layer"] = {{{"mark", {{"type", "bar"}, {"color", "var(--color-0)"}, {"opacity", 0.8}}}},
                   {{"mark", {{"type", "text"}, {"align", "left"}, {"dx", 4}, {"color", "var(--ink)"}}},
                    {"encoding", {{"text", makeQuantitative("seconds", "", {{"format", ".3~g"}})}}}}};
  DataTable table;
  table.add("stage", std::move(stages));
  table.add("seconds", std::move(times));
  page.tables["stages"] = std::move(table);
  addFigure({"stages",
             "Time per stage",
             "Wall time of each stage of the run, in its order.",
             "stages",
             {{"Wall time of each stage", spec}},
             {},
             1},
            section);
}

void appendRows(const Json& record, const std::string& prefix, std::vector<std::vector<HtmlCell>>& rows) {
  for (const auto& [key, value] : record.items()) {
    if (value.is_object()) {
      appendRows(value, prefix + key + ": ", rows);
    } else if (!value.is_array()) {
      rows.push_back({makeTextCell(prefix + key), makeTextCell(toPlainText(value))});
    }
  }
}

void addProvenance(const RunFolder& run, Section& section) {
  section.html += makeElement("h3", "Provenance") + "\n";
  section.html +=
      makeParagraph("To repeat this run, bit for bit on the same type of machine, in its folder:");
  section.html += makeElement("pre", makeElement("code", "twinmap run resolved.yaml")) + "\n";
  if (const Json* command = findRecord(run, "command")) {
    section.html += makeParagraph("It was made by:") +
                    makeElement("pre", makeElement("code", escapeHtml(toPlainText(*command)))) + "\n";
  }
  if (run.provenance.is_object()) {
    Json others = run.provenance;
    others.erase("seconds");
    others.erase("command");
    std::vector<std::vector<HtmlCell>> rows;
    appendRows(others, "", rows);
    section.html += makeHtmlTable("provenance", "As in provenance.json.", {"what", "value"}, rows);
  }
}

}  // namespace

void addCost(const RunFolder& run, Page& page) {
  Section section{"cost", "Cost, failures, provenance", "", {}};
  section.html = makeCostFacts(run);
  addStages(run, section, page);
  addFailures(run, section, page);
  addProvenance(run, section);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
