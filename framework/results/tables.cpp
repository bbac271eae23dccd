#include "framework/results/tables.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/markdown_table.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/number_with_error.hpp"

namespace twinmap {
namespace {

using Row = std::vector<std::string>;

constexpr int kBoundDigits = 6;
constexpr int kPercentDecimals = 4;  // as in the paper
constexpr int kCoverageDecimals = 3;
constexpr const char* kLegend =
    "In parentheses: the Monte Carlo standard error of the last digits, 0.938(30) = 0.938 with error "
    "0.030.\n";

constexpr std::size_t kTextColumns = 2;  // to the left; numbers to the right

Row makeHeader(const RunSummary& run) {
  Row header{"parameter", "unit", "lower", "upper", "bias %", "sd %", "MARE %", "cov. 95 %"};
  if (run.evaluation.limit_stddev.size() > 0) {
    header.insert(header.end(), {"limit %", "ratio"});
  }
  return header;
}

Row makeRow(const RunSummary& run, std::size_t p) {
  const ParameterSpec& parameter = run.parameters[p];
  const ParameterMetrics& m = run.evaluation.metrics[p];
  const auto with_error = [&m](double ParameterFigures::*figure, int decimals) {
    return toTextWithError(m.*figure, m.se.*figure, decimals);
  };
  Row row{parameter.name.text,
          parameter.unit,
          toShortText(parameter.bounds.lower, kBoundDigits),
          toShortText(parameter.bounds.upper, kBoundDigits),
          with_error(&ParameterFigures::bias_pct, kPercentDecimals),
          with_error(&ParameterFigures::sd_pct, kPercentDecimals),
          toFixedText(m.mare_pct, kPercentDecimals),
          with_error(&ParameterFigures::coverage95, kCoverageDecimals)};
  if (run.evaluation.limit_stddev.size() > 0) {
    row.push_back(toFixedText(m.limit_pct, kPercentDecimals));
    row.push_back(with_error(&ParameterFigures::ratio_to_limit, kCoverageDecimals));
  }
  return row;
}

/// Header and a row a parameter, each cell escaped.
std::vector<Row> makeRows(const RunSummary& run, std::string (*escape)(const std::string&)) {
  std::vector<Row> rows{makeHeader(run)};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    rows.push_back(makeRow(run, p));
  }
  for (Row& row : rows) {
    std::transform(row.begin(), row.end(), row.begin(), escape);
  }
  return rows;
}

/// How many of the answers are refined, where any was to be.
std::string makeRefinementLegend(const RunSummary& run) {
  const std::vector<Refined>& refined = run.evaluation.refined;
  if (refined.empty()) {
    return "";
  }
  const auto accepted =
      std::count_if(refined.begin(), refined.end(), [](const Refined& one) { return one.isAccepted(); });
  return fmt::format("Refined on the simulator: {} of {} answers; methods.csv has those of the map alone.\n",
                     accepted, refined.size());
}

}  // namespace

std::string makeMarkdownTable(const RunSummary& run) {
  return makeAlignedTable(makeRows(run, escapeMarkdown), kTextColumns) + "\n" + kLegend +
         makeRefinementLegend(run);
}

std::string makeLatexTable(const RunSummary& run) {
  const std::vector<Row> rows = makeRows(run, escapeLatex);
  const auto make_line = [](const Row& row) {
    std::string line = row[0];
    for (std::size_t i = 1; i < row.size(); ++i) {
      line += " & " + row[i];
    }
    return line + " \\\\\n";
  };
  std::string text = "\\begin{tabular}{ll" + std::string(rows[0].size() - kTextColumns, 'r') +
                     "}\n\\toprule\n" + make_line(rows[0]) + "\\midrule\n";
  for (std::size_t i = 1; i < rows.size(); ++i) {
    text += make_line(rows[i]);
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace twinmap
