#include "framework/results/tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

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

/// "multimodal 12 %, at_bounds 1 %": each status but ok, the most frequent first.
std::string listStatuses(const AnswerSummary& answers) {
  constexpr double kPercent = 100.0;
  std::set<std::string> names;
  for (const TestAnswer& answer : answers.answers) {
    names.insert(answer.statuses.begin(), answer.statuses.end());
  }
  names.erase("ok");
  std::vector<std::pair<double, std::string>> shares;
  for (const std::string& name : names) {
    const double share = answers.calcShare([&](const TestAnswer& answer) { return answer.has(name); });
    if (share > 0.0) {
      shares.emplace_back(-share, name);
    }
  }
  std::sort(shares.begin(), shares.end());
  std::string text;
  for (const auto& [share, name] : shares) {
    text += fmt::format("{}{} {:.3g} %", text.empty() ? "" : ", ", name, -kPercent * share);
  }
  return text;
}

/// How the estimates were made, and what `twinmap infer` says against them.
std::string makeAnswerLegend(const RunSummary& run) {
  constexpr double kPercent = 100.0;
  if (!run.evaluation.answers) {
    return "";
  }
  const AnswerSummary& answers = *run.evaluation.answers;
  const std::vector<Refined>& refined = run.evaluation.refined;
  const auto accepted =
      std::count_if(refined.begin(), refined.end(), [](const Refined& one) { return one.isAccepted(); });
  std::string text =
      fmt::format("Refined on the simulator: {} of {} estimates; methods.csv has the quick ones too.\n",
                  accepted, refined.size());
  if (answers.needing > 0) {
    text += fmt::format("Replaced by the posterior on the simulator, as by infer: {} estimates{}.\n",
                        answers.needing,
                        answers.sampled < answers.needing
                            ? fmt::format("; {} of these were sampled and stand for all", answers.sampled)
                            : "");
  }
  if (const double share = answers.calcNotOk(); share > 0.0) {
    text += fmt::format("Not ok by infer: {:.3g} % of the test samples ({}).\n", kPercent * share,
                        listStatuses(answers));
  }
  if (answers.calcShare([](const TestAnswer& answer) { return answer.has("multimodal"); }) > 0.0) {
    text +=
        "Of several values that fit (multimodal), errors are to the nearest; intervals hold all of them.\n";
  }
  return text;
}

}  // namespace

std::string makeMarkdownTable(const RunSummary& run) {
  return makeMarkdownRows(makeRows(run, escapeMarkdown), kTextColumns) + "\n" + kLegend +
         makeAnswerLegend(run);
}

std::string makeLatexTable(const RunSummary& run) {
  return makeLatexRows(makeRows(run, escapeLatex), kTextColumns);
}

}  // namespace twinmap
