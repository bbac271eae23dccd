#include "framework/results/comparison/comparison_text.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"

namespace twinmap {
namespace {

using Row = std::vector<std::string>;

std::string toCell(double value, int digits) {
  return std::isnan(value) ? "-" : toShortText(value, digits);
}

bool isApart(const ComparedFigure& figure) {
  return figure.lower > 0.0 || figure.upper < 0.0;
}

std::vector<Row> makeFigureRows(const RunComparison& comparison) {
  constexpr int kDigits = 5, kIntervalDigits = 3;
  std::vector<Row> rows{{"parameter", "figure", "A", "B", "B - A", "from", "to", ""}};
  for (const ComparedParameter& parameter : comparison.parameters) {
    for (const ComparedFigure& figure : parameter.figures) {
      const bool first = &figure == &parameter.figures.front();
      rows.push_back({first ? parameter.name : "", figure.name, toCell(figure.a, kDigits),
                      toCell(figure.b, kDigits), toCell(figure.difference, kIntervalDigits),
                      toCell(figure.lower, kIntervalDigits), toCell(figure.upper, kIntervalDigits),
                      isApart(figure) ? "*" : ""});
    }
  }
  return rows;
}

std::string describeIntervals(const RunComparison& comparison) {
  const std::string intervals =
      "from, to: 95 % bootstrap interval of B - A (BCa, 10000 resamples) over the test samples; * where it "
      "does not contain 0.\n";
  if (comparison.paired) {
    return intervals + fmt::format("Both inferred the same {} test samples: the intervals are of pairs.\n",
                                   comparison.samples_a);
  }
  return intervals + "The test sets are not the same (" + comparison.difference_of_sets +
         "): the intervals are of independent sets, wider than those of pairs.\n";
}

std::string nameThoseOf(const std::string& run, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text.empty() ? "" : "Only " + run + " has " + text + ".\n";
}

std::string listKeys(const std::vector<KeyDifference>& keys) {
  if (keys.empty()) {
    return "The experiments are the same.\n";
  }
  std::vector<Row> rows{{"key of resolved.yaml", "A", "B"}};
  for (const KeyDifference& key : keys) {
    rows.push_back({key.key, key.before, key.after});
  }
  return alignRows(rows, rows[0].size());
}

std::string toCsvCell(double value) {
  return std::isnan(value) ? "" : toText(value);
}

Json toJson(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json toJson(const ComparedParameter& parameter) {
  Json figures;
  for (const ComparedFigure& figure : parameter.figures) {
    figures[figure.name] = {{"a", toJson(figure.a)},
                            {"b", toJson(figure.b)},
                            {"difference", toJson(figure.difference)},
                            {"lower", toJson(figure.lower)},
                            {"upper", toJson(figure.upper)}};
  }
  return {{"name", parameter.name}, {"unit", parameter.unit}, {"figures", figures}};
}

}  // namespace

std::string makeComparisonText(const RunComparison& comparison) {
  std::string text = "A: " + comparison.folder_a + "\nB: " + comparison.folder_b + "\n\n";
  if (!comparison.parameters.empty()) {
    text += alignRows(makeFigureRows(comparison), 2) + "\n" + describeIntervals(comparison);
  }
  return text + nameThoseOf("A", comparison.only_a) + nameThoseOf("B", comparison.only_b) + "\n" +
         listKeys(comparison.keys);
}

std::string makeComparisonCsv(const RunComparison& comparison) {
  std::vector<CsvRow> rows{
      {"parameter", "unit", "figure", "a", "b", "difference", "lower", "upper", "paired"}};
  for (const ComparedParameter& parameter : comparison.parameters) {
    for (const ComparedFigure& figure : parameter.figures) {
      rows.push_back({parameter.name, parameter.unit, figure.name});
      for (const double value : {figure.a, figure.b, figure.difference, figure.lower, figure.upper}) {
        rows.back().push_back(toCsvCell(value));
      }
      rows.back().emplace_back(comparison.paired ? "1" : "0");
    }
  }
  return makeCsv(rows);
}

std::string makeComparisonJson(const RunComparison& comparison) {
  Json json;
  json["a"] = {
      {"folder", comparison.folder_a}, {"test_samples", comparison.samples_a}, {"only", comparison.only_a}};
  json["b"] = {
      {"folder", comparison.folder_b}, {"test_samples", comparison.samples_b}, {"only", comparison.only_b}};
  json["paired"] = comparison.paired;
  json["difference_of_sets"] = comparison.difference_of_sets;
  json["parameters"] = Json::array();
  for (const ComparedParameter& parameter : comparison.parameters) {
    json["parameters"].push_back(toJson(parameter));
  }
  json["keys"] = Json::array();
  for (const KeyDifference& key : comparison.keys) {
    json["keys"].push_back({{"key", key.key}, {"a", key.before}, {"b", key.after}});
  }
  constexpr int kIndent = 2;
  return formatJson(json, kIndent) + "\n";
}

}  // namespace twinmap
