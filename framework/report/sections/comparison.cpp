#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/experiment/parameter_figures.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kComparison = "comparison";

/// Labels that tell the runs apart: their folders' names, numbered where two are alike.
std::vector<std::string> makeLabels(const std::vector<RunFolder>& runs) {
  std::vector<std::string> labels;
  for (const RunFolder& run : runs) {
    std::string label = run.label;
    for (int k = 2; std::find(labels.begin(), labels.end(), label) != labels.end(); ++k) {
      label = fmt::format("{} ({})", run.label, k);
    }
    labels.push_back(label);
  }
  return labels;
}

/// The metrics of all runs, run by run, each row with its run's label.
CsvTable uniteMetrics(const std::vector<RunFolder>& runs, const std::vector<std::string>& labels) {
  CsvTable united{{"parameter", "run", "lower", "upper"}, {}};
  for (const FigureColumn& column : kFigureColumns) {
    united.columns.insert(united.columns.end(), {column.name, std::string(column.name) + "_se"});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t row = 0; row < runs[i].metrics.rows.size(); ++row) {
      united.rows.emplace_back();
      for (const std::string& column : united.columns) {
        united.rows.back().push_back(column == "run" ? labels[i] : runs[i].metrics.getText(row, column));
      }
    }
  }
  return united;
}

/// The same, parameter by parameter.
std::string makeMetricsTable(const CsvTable& metrics) {
  CsvTable ordered{metrics.columns, {}};
  for (const std::string& parameter : metrics.listDistinct("parameter")) {
    for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
      if (metrics.getText(row, "parameter") == parameter) {
        ordered.rows.push_back(metrics.rows[row]);
      }
    }
  }
  return makeHtmlTable(
      "comparison-table", "Press a heading to sort.", ordered,
      showFigures({{"parameter", "parameter"}, {"run", "run"}, {"lower", "lower"}, {"upper", "upper"}}));
}

DataTable makeMetricTable(const CsvTable& metrics) {
  DataTable table;
  table.add("run", metrics.listTexts("run"));
  table.add("parameter", metrics.listTexts("parameter"));
  for (const char* column : {"sd_pct", "sd_pct_se", "coverage95", "coverage95_se", "limit_pct"}) {
    table.add(column, metrics.listNumbers(column));
  }
  return table;
}

bool hasLimit(const CsvTable& metrics, const std::string& parameter) {
  for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
    if (metrics.getText(row, "parameter") == parameter &&
        std::isfinite(metrics.getNumber(row, "limit_pct"))) {
      return true;
    }
  }
  return false;
}

/// One row per run: the metric with a bar of 2 standard errors, and a tick for what it is to be held against.
Panel makeRunsPanel(const std::string& figure, const std::string& parameter,
                    const std::vector<std::string>& labels) {
  constexpr int kRowHeight = 28, kFrame = 20;
  return {figure,
          {{"parameter", parameter}},
          {{"height", calcHeight(labels.size(), kRowHeight, kFrame)}, {"runs", labels}}};
}

Figure makeErrorFigure(const CsvTable& metrics, const std::vector<std::string>& parameters,
                       const std::vector<std::string>& labels) {
  Figure figure{"errors-side-by-side",
                "Errors side by side",
                "Further left is better; bars span \u00b12 standard errors where the runs state them, ticks "
                "are the information limit.",
                kComparison,
                {},
                {},
                2};
  for (const std::string& parameter : parameters) {
    figure.panels.push_back(makeRunsPanel(figure.name, parameter, labels));
    if (!hasLimit(metrics, parameter)) {
      figure.panels.back().without = {"limit"};
    }
  }
  return figure;
}

Figure makeCoverageFigure(const std::vector<std::string>& parameters,
                          const std::vector<std::string>& labels) {
  Figure figure{"coverage-side-by-side",
                "Coverage side by side",
                "On the dashed line the intervals are calibrated; left of it they are too narrow.",
                kComparison,
                {},
                {},
                2};
  for (const std::string& parameter : parameters) {
    figure.panels.push_back(makeRunsPanel(figure.name, parameter, labels));
  }
  return figure;
}

}  // namespace

void addComparison(const std::vector<RunFolder>& runs, Page& page) {
  const std::vector<std::string> labels = makeLabels(runs);
  const CsvTable metrics = uniteMetrics(runs, labels);
  const std::vector<std::string> parameters = metrics.listDistinct("parameter");
  page.tables[kComparison] = makeMetricTable(metrics);
  Section section{"comparison", "Side by side", "", {}};
  section.html = makeMetricsTable(metrics);
  addFigure(makeErrorFigure(metrics, parameters, labels), section);
  addFigure(makeCoverageFigure(parameters, labels), section);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
