#include <algorithm>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

/// The metrics as the table shows them: the shown columns that the file has, rounded to their errors.
std::vector<CsvRow> makeTextRows(const CsvTable& metrics, const std::vector<ShownColumn>& columns,
                                 std::string (*escape)(const std::string&)) {
  std::vector<CsvRow> rows(metrics.rows.size() + 1);
  for (const ShownColumn& column : columns) {
    if (!metrics.hasColumn(column.name)) {
      continue;
    }
    rows[0].push_back(escape(column.heading));
    const std::vector<HtmlCell> cells = makeCells(metrics, column);
    for (std::size_t row = 0; row < cells.size(); ++row) {
      rows[row + 1].push_back(
          escape(cells[row].is_number ? cells[row].shown : metrics.getText(row, column.name)));
    }
  }
  return rows;
}

/// Figures of all parameters together.
std::string makeJoint(const CsvTable& joint) {
  if (joint.empty()) {
    return "";
  }
  CsvTable named = joint;
  std::replace(named.columns.begin(), named.columns.end(), std::string("se"), std::string("value_se"));
  return makeElement("h3", "All parameters together") + "\n" +
         makeHtmlTable(
             "joint-table",
             "Coverage of the joint confidence ellipsoids, and the NLPD of the parameters as a vector.",
             named, {{"metric", "metric"}, {"value", "value"}});
}

std::string makeBaselines(const CsvTable& baselines) {
  if (baselines.empty()) {
    return "";
  }
  return makeElement("h3", "Beside other methods, on the same test data") + "\n" +
         makeHtmlTable("baselines", "Relative errors in %, coverage, and seconds per update.", baselines,
                       showFigures({{"method", "method"}, {"samples", "samples"}, {"parameter", "parameter"}},
                                   {{"seconds_per_update", "s / update"}, {"unconverged", "unconverged"}}));
}

}  // namespace

std::string makeErrorsTable(const CsvTable& metrics) {
  return metrics.empty()
             ? ""
             : makeHtmlTable("errors-table",
                             "Standard deviation of the relative error of the test samples, the smallest "
                             "that the noise permits, and the share of true values in the 95 % intervals.",
                             metrics,
                             {{"parameter", "parameter"},
                              {"unit", "unit"},
                              {"lower", "lower"},
                              {"upper", "upper"},
                              {"sd_pct", "sd %"},
                              {"limit_pct", "limit %"},
                              {"ratio_to_limit", "ratio"},
                              {"coverage95", "coverage 95 %"}});
}

void addMetrics(const RunFolder& run, Page& page) {
  const CsvTable& metrics = run.metrics;
  if (metrics.empty()) {
    return;
  }
  constexpr std::size_t kTextColumns = 2;
  const std::vector<ShownColumn> columns =
      showFigures({{"parameter", "parameter"}, {"unit", "unit"}, {"lower", "lower"}, {"upper", "upper"}},
                  {{"not_ok", "not ok"}});
  page.texts.emplace_back("metrics-csv", makeCsv(metrics));
  page.texts.emplace_back("metrics-markdown",
                          makeMarkdownRows(makeTextRows(metrics, columns, escapeMarkdown), kTextColumns));
  page.texts.emplace_back("metrics-latex",
                          makeLatexRows(makeTextRows(metrics, columns, escapeLatex), kTextColumns));
  Section section{"metrics", "Errors of the estimates", "", {}};
  const std::string all =
      makeHtmlTable("metrics-table", "Press a heading to sort.", metrics, columns) +
      makeCopyButtons(
          {{"metrics-csv", "CSV"}, {"metrics-markdown", "Markdown"}, {"metrics-latex", "LaTeX"}}) +
      makeParagraph(
          "Bias, sd and MARE are the mean, standard deviation and mean absolute value of the relative error "
          "over the test samples; coverage is the fraction of true values within the interval. " +
              std::string(metrics.hasColumn("limit_pct")
                              ? "The limit is the smallest sd that the noise of the data allows any method. "
                              : "") +
              (metrics.hasColumn("not_ok") ? "Not ok is the fraction of the test samples of which twinmap "
                                             "infer says so (refined.csv has its statuses). "
                                           : "") +
              (metrics.hasColumn("sd_pct_se")
                   ? "The digits in parentheses are the Monte Carlo standard error of the last digits."
                   : ""),
          "class=\"quiet\"") +
      makeJoint(run.joint) + makeBaselines(run.baselines);
  section.html += makeFolded("All figures: bias, MARE, NLPD, coverage, joint figures, other methods", all);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
