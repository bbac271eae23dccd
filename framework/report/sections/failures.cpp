#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "framework/report/html.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr std::size_t kMaxFailures = 1000;  // that are drawn

/// Reasons without their numbers, so that alike ones are counted together.
std::string makeKind(const std::string& reason) {
  std::string kind;
  for (const char c : reason) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit) {
      kind += c;
    } else if (kind.empty() || kind.back() != '#') {
      kind += '#';
    }
  }
  return kind;
}

std::string makeReasonTable(const CsvTable& failures) {
  struct Kind {
    int count = 0;
    std::string example;
  };
  std::map<std::string, Kind> kinds;
  for (std::size_t row = 0; row < failures.rows.size(); ++row) {
    Kind& kind = kinds[makeKind(failures.getText(row, "reason"))];
    ++kind.count;
    kind.example = kind.example.empty() ? failures.getText(row, "reason") : kind.example;
  }
  std::vector<std::pair<std::string, Kind>> sorted(kinds.begin(), kinds.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
  constexpr std::size_t kMaxKinds = 50;
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t i = 0; i < std::min(sorted.size(), kMaxKinds); ++i) {
    rows.push_back(
        {makeNumberCell(std::to_string(sorted[i].second.count)), makeTextCell(sorted[i].second.example)});
  }
  return makeHtmlTable("reasons", "Why, with one example of each kind of reason; all are in failures.csv.",
                       {"samples", "reason"}, rows);
}

DataTable makeFailuresTable(const RunFolder& run) {
  const CsvTable& failures = run.failures;
  const std::size_t count = std::min(failures.rows.size(), kMaxFailures);
  std::vector<std::string> sets, samples, reasons;
  for (std::size_t row = 0; row < count; ++row) {
    sets.push_back(failures.getText(row, "set"));
    samples.push_back(failures.getText(row, "sample"));
    reasons.push_back(failures.getText(row, "reason").substr(0, 200));
  }
  DataTable table;
  table.add("set", sets);
  table.add("failed_sample", samples);
  for (const ParameterSpec& parameter : run.experiment.model.parameters) {
    std::vector<double> values;
    for (std::size_t row = 0; row < count; ++row) {
      values.push_back(failures.getNumber(row, parameter.name.text));
    }
    table.add(getTrueColumn(parameter.name.text), values);
  }
  table.add("reason", reasons);
  return table;
}

}  // namespace

void addFailures(const RunFolder& run, Section& section, Page& page) {
  if (run.failures.empty()) {
    section.html += makeElement("h3", "Failures") + makeParagraph("Every sample could be simulated.");
    return;
  }
  page.tables["failures"] = makeFailuresTable(run);
  Panel panel{"failures", {}, makeChosenDomains()};
  if (run.predictions.empty()) {
    panel.without = {"samples"};
  }
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  const std::size_t last = parameters.size() - 1;
  Figure figure{"failures",
                "Failures: where within the bounds",
                "Crosses are the samples that could not be simulated, training and test; dots are test "
                "samples that could. Crosses along an edge ask for tighter bounds there.",
                "failures",
                {panel},
                {},
                1};
  figure.choices = {makeParameterChoice("x", "across", parameters, last == 0 ? 0 : last - 1),
                    makeParameterChoice("y", "up", parameters, last)};
  addFigure(std::move(figure), section);
  section.html += makeReasonTable(run.failures);
  if (run.failures.rows.size() > kMaxFailures) {
    section.html += makeParagraph(
        fmt::format("The first {} of {} failures are drawn.", kMaxFailures, run.failures.rows.size()));
  }
}

}  // namespace twinmap
