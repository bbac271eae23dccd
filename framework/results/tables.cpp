#include "framework/results/tables.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/number_with_error.hpp"
#include "framework/base/text/text_tables.hpp"

namespace twinmap {
namespace {

using Row = std::vector<std::string>;

constexpr int kBoundDigits = 6;
constexpr const char* kLegend =
    "In parentheses: the Monte Carlo standard error of the last digits, 0.938(30) = 0.938 with error "
    "0.030.\n";

constexpr std::size_t kTextColumns = 2;  // to the left; numbers to the right

bool isPrinted(const FigureColumn& column, const RunSummary& run) {
  return column.in_print != InPrint::kOmitted &&
         (!column.needs_limit || run.evaluation.limit_stddev.size() > 0);
}

Row makeHeader(const RunSummary& run) {
  Row header{"parameter", "unit", "lower", "upper"};
  for (const FigureColumn& column : kFigureColumns) {
    if (isPrinted(column, run)) {
      header.emplace_back(column.heading);
    }
  }
  return header;
}

Row makeRow(const RunSummary& run, const ParameterSpec& parameter, const ParameterMetrics& metrics) {
  Row row{parameter.name.text, parameter.unit, toShortText(parameter.bounds.lower, kBoundDigits),
          toShortText(parameter.bounds.upper, kBoundDigits)};
  for (const FigureColumn& column : kFigureColumns) {
    if (isPrinted(column, run)) {
      const double error = column.in_print == InPrint::kWithError ? metrics.se.*column.value : 0.0;
      row.push_back(toTextWithError(metrics.*column.value, error, column.decimals));
    }
  }
  return row;
}

/// Header and a row a parameter, then one a derived quantity, each cell escaped.
std::vector<Row> makeRows(const RunSummary& run, std::string (*escape)(const std::string&)) {
  std::vector<Row> rows{makeHeader(run)};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    rows.push_back(makeRow(run, run.parameters[p], run.evaluation.metrics[p]));
  }
  if (run.evaluation.derived) {
    const DerivedEvaluation& derived = *run.evaluation.derived;
    for (std::size_t k = 0; k < derived.quantities.size(); ++k) {
      rows.push_back(makeRow(run, derived.quantities[k], derived.metrics[k]));
    }
  }
  for (Row& row : rows) {
    std::transform(row.begin(), row.end(), row.begin(), escape);
  }
  return rows;
}

/// How many of the estimates are refined, where any was to be.
std::string makeRefinementLegend(const RunSummary& run) {
  const std::vector<Refined>& refined = run.evaluation.refined;
  if (refined.empty()) {
    return "";
  }
  const auto accepted =
      std::count_if(refined.begin(), refined.end(), [](const Refined& one) { return one.isAccepted(); });
  return fmt::format("Refined on the simulator: {} of {} estimates; methods.csv has the quick ones too.\n",
                     accepted, refined.size());
}

}  // namespace

std::string makeMarkdownTable(const RunSummary& run) {
  return makeMarkdownRows(makeRows(run, escapeMarkdown), kTextColumns) + "\n" + kLegend +
         makeRefinementLegend(run);
}

std::string makeLatexTable(const RunSummary& run) {
  return makeLatexRows(makeRows(run, escapeLatex), kTextColumns);
}

}  // namespace twinmap
