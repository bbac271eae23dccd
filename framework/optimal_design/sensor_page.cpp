#include "framework/optimal_design/sensor_page.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/optimal_design/sensor_files.hpp"
#include "framework/report/figure.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/verdict.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Cells = std::vector<HtmlCell>;

std::string makeTable(const std::string& id, const std::string& caption, const SensorDesign& design,
                      const std::vector<JudgedSubset>& choices, bool of_outputs) {
  std::vector<std::string> headings{of_outputs ? "outputs" : "sample times", "criterion"};
  for (const ParameterSpec& parameter : design.parameters) {
    headings.push_back("sd of " + makeLabel(parameter));
  }
  if (of_outputs) {
    headings.insert(headings.begin() + 1, "which");
  }
  std::vector<Cells> rows;
  for (const JudgedSubset& judged : choices) {
    rows.push_back({makeNumberCell(std::to_string(judged.subset.size()))});
    if (of_outputs) {
      rows.back().push_back(makeTextCell(nameOutputs(design, judged.subset)));
    }
    rows.back().push_back(makeNumberCell(toText(judged.cost)));
    for (const auto& stddev : judged.stddev.rowwise()) {
      rows.back().push_back(makeNumberCell(toText(stddev.mean())));
    }
  }
  return makeHtmlTable(id, caption, headings, rows);
}

/// What is left of the bounds' own standard deviation, by the number of candidates.
DataTable makeCurve(const SensorDesign& design, const std::vector<JudgedSubset>& choices) {
  const Eigen::VectorXd widths = calcWidths(design.parameters);
  std::vector<std::string> parameters;
  std::vector<double> counts, remaining;
  for (const JudgedSubset& judged : choices) {
    for (Index p = 0; p < widths.size(); ++p) {
      parameters.push_back(design.parameters[static_cast<std::size_t>(p)].name.text);
      counts.push_back(static_cast<double>(judged.subset.size()));
      remaining.push_back(100.0 * judged.stddev.row(p).mean() / widths[p]);
    }
  }
  DataTable table;
  table.add("parameter", std::move(parameters));
  table.add("count", std::move(counts));
  table.add("remaining", std::move(remaining));
  return table;
}

void addCurve(const std::string& table, const std::string& caption, const std::string& what,
              const SensorDesign& design, const std::vector<JudgedSubset>& choices, Page& page,
              Section& section) {
  std::vector<std::string> names;
  for (const ParameterSpec& parameter : design.parameters) {
    names.push_back(parameter.name.text);
  }
  page.tables[table] = makeCurve(design, choices);
  addFigure({table,
             caption,
             "The information limit, mean over the bounds, in % of the width of each parameter's bounds.",
             table,
             {{"sensor-curve", {{"table", table}, {"what", what}}, {{"parameters", names}}}},
             {},
             1},
            section);
}

void addTimes(const SensorDesign& design, Page& page, Section& section) {
  std::vector<double> times;
  std::vector<std::string> chosen;
  for (Index t = 0; t < design.times.size(); ++t) {
    const bool is_chosen = std::binary_search(design.chosen_times.begin(), design.chosen_times.end(), t);
    times.push_back(design.times[t]);
    chosen.emplace_back(is_chosen ? "measured" : "not measured");
  }
  page.tables["sample-times"].add("time", std::move(times));
  page.tables["sample-times"].add("chosen", std::move(chosen));
  addFigure({"sample-times", "When to measure", "", "sample-times", {{"sensor-times", {}}}, {}, 1}, section);
}

}  // namespace

std::string makeSensorPage(const std::string& name, const SensorDesign& design) {
  Page page;
  page.title = "Sensors of " + name;
  Section outputs{"outputs", "Which outputs", "", {}};
  outputs.html =
      makeTable("outputs-table",
                fmt::format("The best of each number of outputs, measured at all times. Chosen: {}.",
                            nameOutputs(design, design.chosen_outputs.subset)),
                design, design.by_outputs, true) +
      makeWarningList(design.warnings);
  addCurve("output-curve", "What each further output buys", "outputs", design, design.by_outputs, page,
           outputs);
  page.sections.push_back(std::move(outputs));
  if (!design.by_times.empty()) {
    Section times{"times", "Which sample times", "", {}};
    times.html = makeTable("times-table", "The best of some numbers of sample times of the chosen outputs.",
                           design, design.by_times, false);
    addCurve("time-curve", "What further sample times buy", "sample times", design, design.by_times, page,
             times);
    addTimes(design, page, times);
    page.sections.push_back(std::move(times));
  }
  return makePage(page);
}

}  // namespace twinmap::experiment_design
