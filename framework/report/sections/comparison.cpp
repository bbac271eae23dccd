#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/metric_columns.hpp"
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

DataTable makeMetricTable(const std::vector<RunFolder>& runs, const std::vector<std::string>& labels) {
  const std::vector<std::string> metrics{"sd_pct", "sd_pct_se", "coverage95", "coverage95_se", "limit_pct"};
  std::vector<std::string> run, parameter;
  std::vector<std::vector<double>> values(metrics.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t row = 0; row < runs[i].metrics.rows.size(); ++row) {
      run.push_back(labels[i]);
      parameter.push_back(runs[i].metrics.getText(row, "parameter"));
      for (std::size_t m = 0; m < metrics.size(); ++m) {
        values[m].push_back(runs[i].metrics.getNumber(row, metrics[m]));
      }
    }
  }
  DataTable table;
  table.add("run", run);
  table.add("parameter", parameter);
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    table.add(metrics[m], values[m]);
  }
  return table;
}

std::vector<std::string> collectRunParameters(const std::vector<RunFolder>& runs) {
  std::vector<std::string> names;
  for (const RunFolder& run : runs) {
    for (std::size_t row = 0; row < run.metrics.rows.size(); ++row) {
      const std::string& name = run.metrics.getText(row, "parameter");
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  return names;
}

bool hasLimit(const std::vector<RunFolder>& runs, const std::string& parameter) {
  for (const RunFolder& run : runs) {
    for (std::size_t row = 0; row < run.metrics.rows.size(); ++row) {
      if (run.metrics.getText(row, "parameter") == parameter &&
          std::isfinite(run.metrics.getNumber(row, "limit_pct"))) {
        return true;
      }
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

Figure makeErrorFigure(const std::vector<RunFolder>& runs, const std::vector<std::string>& parameters,
                       const std::vector<std::string>& labels) {
  Figure figure{
      "errors-side-by-side",
      "Errors side by side",
      "Further left is better; bars span \u00b12 standard errors where the runs state them, ticks are the "
      "information limit.",
      kComparison,
      {},
      {},
      2};
  for (const std::string& parameter : parameters) {
    figure.panels.push_back(makeRunsPanel(figure.name, parameter, labels));
    if (!hasLimit(runs, parameter)) {
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

std::string makeMetricsTable(const std::vector<RunFolder>& runs, const std::vector<std::string>& labels) {
  std::vector<std::string> headings{"parameter", "run"};
  for (const MetricColumn& column : getMetricColumns()) {
    headings.push_back(column.heading);
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (const std::string& parameter : collectRunParameters(runs)) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const CsvTable& metrics = runs[i].metrics;
      for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
        if (metrics.getText(row, "parameter") != parameter) {
          continue;
        }
        rows.push_back({makeTextCell(parameter), makeTextCell(labels[i])});
        for (const MetricColumn& column : getMetricColumns()) {
          rows.back().push_back(makeNumberCell(metrics.getText(row, column.name), kMetricDigits,
                                               metrics.getText(row, column.name + "_se")));
        }
      }
    }
  }
  return makeHtmlTable("comparison-table", "Press a heading to sort.", headings, rows);
}

}  // namespace

void addComparison(const std::vector<RunFolder>& runs, Page& page) {
  const std::vector<std::string> labels = makeLabels(runs);
  const std::vector<std::string> parameters = collectRunParameters(runs);
  page.tables[kComparison] = makeMetricTable(runs, labels);
  Section section{"comparison", "Side by side", "", {}};
  section.html = makeMetricsTable(runs, labels);
  addFigure(makeErrorFigure(runs, parameters, labels), section);
  addFigure(makeCoverageFigure(parameters, labels), section);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
