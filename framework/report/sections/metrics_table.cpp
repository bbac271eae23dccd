#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/metric_columns.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

using TextRow = std::vector<std::string>;

/// Each metric that the file has, with its standard error where that is there too.
std::vector<MetricColumn> findColumns(const CsvTable& metrics) {
  std::vector<MetricColumn> found;
  for (const MetricColumn& column : getMetricColumns()) {
    if (metrics.hasColumn(column.name)) {
      found.push_back(column);
    }
  }
  return found;
}

std::string joinRow(const TextRow& cells, const std::string& separator,
                    std::string (*escape)(const std::string&)) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += (i == 0 ? "" : separator) + escape(cells[i]);
  }
  return line;
}

std::string makeMarkdown(const std::vector<TextRow>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += "| " + joinRow(rows[i], " | ", escapeMarkdown) + " |\n";
    for (std::size_t cell = 0; i == 0 && cell < rows[0].size(); ++cell) {
      text += (cell < 2 ? "|---" : "|--:") + std::string(cell + 1 == rows[0].size() ? "|\n" : "");
    }
  }
  return text;
}

std::string makeLatex(const std::vector<TextRow>& rows) {
  std::string text = "\\begin{tabular}{ll" + std::string(rows[0].size() - 2, 'r') + "}\n\\toprule\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += joinRow(rows[i], " & ", escapeLatex) + " \\\\\n" + (i == 0 ? "\\midrule\n" : "");
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

/// As the table shows it.
std::string makeText(const CsvTable& metrics, std::size_t row, const MetricColumn& column) {
  return makeNumberCell(metrics.getText(row, column.name), kMetricDigits,
                        metrics.getText(row, column.name + "_se"))
      .shown;
}

std::vector<TextRow> makeTextRows(const CsvTable& metrics, const std::vector<MetricColumn>& columns) {
  std::vector<TextRow> rows{{"parameter", "unit"}};
  for (const MetricColumn& column : columns) {
    rows[0].push_back(column.heading);
  }
  for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
    rows.push_back({metrics.getText(row, "parameter"), metrics.getText(row, "unit")});
    for (const MetricColumn& column : columns) {
      rows.back().push_back(makeText(metrics, row, column));
    }
  }
  return rows;
}

/// Figures of all parameters together.
std::string makeJoint(const CsvTable& joint) {
  if (joint.empty()) {
    return "";
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < joint.rows.size(); ++row) {
    rows.push_back({makeTextCell(joint.getText(row, "metric")),
                    makeNumberCell(joint.getText(row, "value"), kMetricDigits, joint.getText(row, "se"))});
  }
  return makeElement("h3", "All parameters together") + "\n" +
         makeHtmlTable("joint-table",
                       "Coverage of the inferred ellipsoids, and the NLPD of the parameters as a vector.",
                       {"metric", "value"}, rows);
}

std::string makeBaselines(const CsvTable& baselines) {
  if (baselines.empty()) {
    return "";
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (const TextRow& cells : baselines.rows) {
    rows.emplace_back();
    for (const std::string& cell : cells) {
      double number = 0.0;
      rows.back().push_back(parseLiteral(cell, number) ? makeNumberCell(cell) : makeTextCell(cell));
    }
  }
  return makeElement("h3", "Beside other methods, on the same test data") + "\n" +
         makeHtmlTable("baselines", "Relative errors in %, coverage, and seconds per update.",
                       baselines.columns, rows);
}

}  // namespace

const std::vector<MetricColumn>& getMetricColumns() {
  static const std::vector<MetricColumn> columns{{"lower", "lower"},
                                                 {"upper", "upper"},
                                                 {"bias_pct", "bias %"},
                                                 {"sd_pct", "sd %"},
                                                 {"mare_pct", "MARE %"},
                                                 {"coverage95", "coverage 95 %"},
                                                 {"limit_pct", "limit %"},
                                                 {"ratio_to_limit", "sd / limit"},
                                                 {"coverage50", "coverage 50 %"},
                                                 {"stddev_pct", "claimed sd %"},
                                                 {"z_sd", "sd of z"},
                                                 {"nlpd", "NLPD"},
                                                 {"crps_pct", "CRPS %"}};
  return columns;
}

std::vector<HtmlCell> makeMetricCells(const CsvTable& metrics, std::size_t row) {
  std::vector<HtmlCell> cells;
  for (const MetricColumn& column : findColumns(metrics)) {
    cells.push_back(makeNumberCell(metrics.getText(row, column.name), kMetricDigits,
                                   metrics.getText(row, column.name + "_se")));
  }
  return cells;
}

std::vector<std::string> makeMetricHeadings(const CsvTable& metrics) {
  std::vector<std::string> headings;
  for (const MetricColumn& column : findColumns(metrics)) {
    headings.push_back(column.heading);
  }
  return headings;
}

void addMetrics(const RunFolder& run, Page& page) {
  const CsvTable& metrics = run.metrics;
  if (metrics.empty()) {
    return;
  }
  std::vector<std::string> headings{"parameter", "unit"};
  for (const std::string& heading : makeMetricHeadings(metrics)) {
    headings.push_back(heading);
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
    rows.push_back(
        {makeTextCell(metrics.getText(row, "parameter")), makeTextCell(metrics.getText(row, "unit"))});
    for (HtmlCell& cell : makeMetricCells(metrics, row)) {
      rows.back().push_back(std::move(cell));
    }
  }
  const std::vector<TextRow> texts = makeTextRows(metrics, findColumns(metrics));
  page.texts.emplace_back("metrics-csv", makeCsv(metrics));
  page.texts.emplace_back("metrics-markdown", makeMarkdown(texts));
  page.texts.emplace_back("metrics-latex", makeLatex(texts));
  Section section{"metrics", "The table", "", {}};
  section.html =
      makeHtmlTable("metrics-table", "Press a heading to sort.", headings, rows) +
      makeCopyButtons(
          {{"metrics-csv", "CSV"}, {"metrics-markdown", "Markdown"}, {"metrics-latex", "LaTeX"}}) +
      makeParagraph(
          "Bias, sd and MARE are the mean, standard deviation and mean absolute value of the relative error "
          "over "
          "the test samples; coverage is the fraction of true values within the inferred interval. " +
              std::string(metrics.hasColumn("limit_pct")
                              ? "The limit is the smallest sd that the noise of the data allows any method. "
                              : "") +
              (metrics.hasColumn("sd_pct_se")
                   ? "The digits in parentheses are the Monte Carlo standard error of the last digits."
                   : ""),
          "class=\"quiet\"") +
      makeJoint(run.joint) + makeBaselines(run.baselines);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
