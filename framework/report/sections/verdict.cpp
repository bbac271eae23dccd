#include "framework/report/sections/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr int kVerdictDigits = 2;

std::string joinNames(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

/// "sd of the relative error from 0.013 % (k_y) to 0.82 % (d_theta)".
std::string describeErrors(const CsvTable& metrics) {
  std::size_t best = 0, worst = 0;
  for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
    best = metrics.getNumber(row, "sd_pct") < metrics.getNumber(best, "sd_pct") ? row : best;
    worst = metrics.getNumber(row, "sd_pct") > metrics.getNumber(worst, "sd_pct") ? row : worst;
  }
  const auto describe = [&](std::size_t row) {
    return toShortText(metrics.getNumber(row, "sd_pct"), kVerdictDigits) + " % (" +
           metrics.getText(row, "parameter") + ")";
  };
  return best == worst ? describe(best) : describe(best) + " to " + describe(worst);
}

double calcMean(const CsvTable& metrics, const std::string& column) {
  double sum = 0.0;
  for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
    sum += metrics.getNumber(row, column);
  }
  return sum / static_cast<double>(metrics.rows.size());
}

std::string makeLead(const RunFolder& run) {
  const ExperimentSpec& experiment = run.experiment;
  const std::string what = joinNames(collectNames(experiment.model.parameters)) + " from " +
                           joinNames(collectNames(experiment.model.outputs));
  if (run.metrics.empty()) {
    return "Estimates " + what + ".";
  }
  const double ratio = calcMean(run.metrics, "ratio_to_limit");
  const double not_ok = run.metrics.getNumber(0, "not_ok");
  return "Estimates " + what + " with an error (sd) of " + describeErrors(run.metrics) +
         (std::isfinite(ratio) ? ", " + toShortText(ratio, 3) + " times the smallest that the noise permits"
                               : "") +
         "; " + toShortText(100.0 * calcMean(run.metrics, "coverage95"), 3) +
         " % of the true values lie in the 95 % intervals" +
         (not_ok > 0.0 ? "; of " + toShortText(100.0 * not_ok, 3) + " % infer says that they are not ok."
                       : ".");
}

constexpr const char* kNotRecorded = "not recorded";

/// "2026-01-02T03:04:05Z" -> "2026-01-02 03:04 UTC".
std::string makeDate(const RunFolder& run) {
  constexpr std::size_t kSeparator = 10, kMinutes = 16;
  const std::string* recorded = run.provenance.find("date");
  std::string date = recorded == nullptr ? kNotRecorded : *recorded;
  if (date.size() > kMinutes && date[kSeparator] == 'T') {
    date = date.substr(0, kMinutes).replace(kSeparator, 1, " ") + " UTC";
  }
  return date;
}

std::string makeSeconds(const RunFolder& run) {
  if (run.provenance.seconds.empty()) {
    return kNotRecorded;
  }
  double seconds = 0.0;
  for (const auto& [stage, time] : run.provenance.seconds) {
    seconds += time;
  }
  return toShortText(seconds, 3) + " s";
}

}  // namespace

std::string makeFacts(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string html = "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts) {
    html +=
        makeElement("div", makeElement("dt", escapeHtml(name)) + makeElement("dd", escapeHtml(value))) + "\n";
  }
  return html + "</dl>\n";
}

std::string makeGateList(const std::vector<GateResult>& gates) {
  if (gates.empty()) {
    return "";
  }
  std::string items;
  for (const GateResult& gate : gates) {
    const std::string mark =
        makeElement("span", gate.passed ? "\u2713 passed" : "\u2717 failed", "class=\"mark\"");
    const std::string text =
        escapeHtml(gate.condition) + " " + makeElement("small", escapeHtml("(" + gate.found + ")"));
    items += makeElement("li", mark + " " + makeElement("span", text),
                         std::string("class=\"") + (gate.passed ? "passed" : "failed") + "\"") +
             "\n";
  }
  return makeElement("h3", "Acceptance criteria") + "\n" + makeElement("ul", items, "class=\"gates\"") + "\n";
}

std::string makeWarningList(const std::vector<std::string>& warnings) {
  const std::string mark = makeElement("span", "\u26a0 warning", "class=\"mark\"") + " ";
  std::string items, remarks;
  for (const std::string& warning : warnings) {
    const std::string text = makeElement("span", escapeHtml(warning));
    (isRemark(warning) ? remarks : items) += makeElement("li", isRemark(warning) ? text : mark + text) + "\n";
  }
  const auto list = [](const char* heading, const std::string& all, const char* attributes) {
    return all.empty() ? "" : makeElement("h3", heading) + "\n" + makeElement("ul", all, attributes) + "\n";
  };
  return list("Warnings", items, "class=\"warnings\"") + list("Remarks", remarks, "class=\"quiet\"");
}

std::string describeCount(const SampleCount& samples) {
  if (samples.number == 0) {
    return "none: no map was trained";
  }
  return std::to_string(samples.number) + (samples.automatic ? ", chosen automatically" : "");
}

void addVerdict(const RunFolder& run, const std::vector<GateResult>& gates, Page& page) {
  const ExperimentSpec& experiment = run.experiment;
  Section section{"verdict", "Verdict", "", {}};
  section.html += makeParagraph(makeLead(run), "class=\"lead\"");
  section.html +=
      experiment.description.empty() ? "" : makeParagraph(experiment.description, "class=\"quiet\"");
  section.html +=
      makeErrorsTable(run.metrics) + makeGateList(gates) + makeWarningList(run.provenance.warnings);
  section.html += makeFacts({{"date", makeDate(run)},
                             {"training samples", describeCount(experiment.design.train.samples)},
                             {"test samples", std::to_string(experiment.design.test.samples)},
                             {"could not be simulated", std::to_string(run.failures.rows.size())},
                             {"seed", std::to_string(experiment.seed)},
                             {"wall time", makeSeconds(run)}});
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
