#include "framework/report/html_report.hpp"

#include <algorithm>

#include "framework/report/escape.hpp"
#include "framework/report/stddev_figure.hpp"
#include "framework/spec/number_text.hpp"

namespace twinmap {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: transparent; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1000px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: 0.2rem; }
h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 0.3rem 0.5rem; text-align: right; border-bottom: 1px solid #8886; white-space: nowrap; }
th:first-child, td:first-child, th:nth-child(2), td:nth-child(2) { text-align: left; }
thead th { border-bottom: 2px solid currentColor; }
.reason { white-space: normal; text-align: left; overflow-wrap: anywhere; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(420px, 100%), 1fr)); gap: 1rem; }
.help { color: #777; max-width: 70ch; }
.warning { border-left: 4px solid #d90; padding-left: 0.8rem; }
)";

constexpr int kDigits = 4;

std::string tag(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

std::string cell(double value) {
  return tag("td", toShortText(value, kDigits));
}

std::string makeMetricsTable(const RunSummary& run) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>parameter</th><th>unit</th><th>lower</th><th>upper</th>"
      "<th>bias %</th><th>sd %</th><th>MARE %</th><th>coverage 95 %</th><th>claimed sd %</th><th>sd of z</th>"
      "</tr></thead><tbody>\n";
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    const ParameterSpec& parameter = run.parameters[p];
    const ParameterMetrics& m = run.metrics[p];
    html += "<tr>" + tag("td", escapeHtml(parameter.name.text)) + tag("td", escapeHtml(parameter.unit));
    for (const double value : {parameter.bounds.lower, parameter.bounds.upper, m.bias_pct, m.sd_pct,
                               m.mare_pct, m.coverage95, m.stddev_pct, m.z_sd}) {
      html += cell(value);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string makeFigures(const RunSummary& run) {
  if (run.axes.empty()) {
    return "";
  }
  std::string html = tag("h2", "How sure is the map, and where?") +
                     "<p class=\"help\">One point per test sample at its true parameters. A parameter is "
                     "inferred best where its points are dark.</p>\n<div class=\"figures\">\n";
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    html += "<figure style=\"margin:0\">" + makeStddevFigure(run, static_cast<int>(p)) + "</figure>\n";
  }
  return html + "</div>\n";
}

std::string makeFailures(const RunSummary& run) {
  if (run.failures.empty()) {
    return "";
  }
  constexpr std::size_t kMostShown = 50;
  const std::size_t shown = std::min(run.failures.size(), kMostShown);
  std::string html =
      tag("h2", "Samples that could not be simulated: " + std::to_string(run.failures.size())) +
      "<p class=\"help\">" +
      (shown < run.failures.size() ? "The first " + std::to_string(shown) + "; all" : "All") +
      " are in failures.csv.</p>\n<div class=\"scroll\"><table><thead><tr><th>set</th>"
      "<th>sample</th>";
  for (const ParameterSpec& parameter : run.parameters) {
    html += tag("th", escapeHtml(parameter.name.text));
  }
  html += "<th class=\"reason\">reason</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < shown; ++i) {
    const FailedSample& failure = run.failures[i];
    html += "<tr>" + tag("td", failure.set) + tag("td", std::to_string(failure.sample));
    for (const double value : failure.parameters) {
      html += cell(value);
    }
    html += "<td class=\"reason\">" + escapeHtml(failure.reason) + "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string makeWarnings(const RunSummary& run) {
  std::string html;
  for (const std::string& warning : run.warnings) {
    html += "<p class=\"warning\">" + escapeHtml(warning) + "</p>\n";
  }
  return html;
}

std::string makeTimes(const RunSummary& run) {
  std::string html = tag("h2", "Cost") +
                     "<table><thead><tr><th>stage</th><th></th><th>seconds</th></tr>"
                     "</thead><tbody>\n";
  for (const StageTime& time : run.times) {
    html += "<tr>" + tag("td", escapeHtml(time.stage)) + "<td></td>" + cell(time.seconds) + "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

}  // namespace

std::string makeHtmlReport(const RunSummary& run) {
  const std::string samples = std::to_string(run.train_samples) + " training samples, " +
                              std::to_string(run.test_samples) + " test samples, " +
                              std::to_string(run.failures.size()) + " could not be simulated.";
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         tag("title", escapeHtml(run.name) + " - twinmap") + tag("style", kStyle) + "</head><body>\n" +
         tag("h1", escapeHtml(run.name)) + tag("p", escapeHtml(run.description)) + "\n" + tag("p", samples) +
         "\n" + makeWarnings(run) + tag("h2", "How well are the parameters inferred?") +
         "<p class=\"help\">Bias, sd and MARE are the mean, standard deviation and mean absolute value of "
         "the "
         "relative error over the test samples. Coverage 95 % is the fraction of them within the inferred 95 "
         "% "
         "interval: 0.95 if the standard deviation is honest.</p>\n" +
         makeMetricsTable(run) + makeFigures(run) + makeFailures(run) + makeTimes(run) + "</body></html>\n";
}

}  // namespace twinmap
