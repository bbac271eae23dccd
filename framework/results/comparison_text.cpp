#include "framework/results/comparison_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/analysis/metrics.hpp"
#include "framework/analysis/paired_bootstrap.hpp"
#include "framework/analysis/sample_terms.hpp"
#include "framework/base/json/json.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/store/finished_run.hpp"

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

namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

struct ComparedColumn {
  double ParameterFigures::*figure;
  bool has_interval = true;
};

/// A coverage counts samples: the few in which two runs disagree are too few for a bootstrap.
constexpr std::array<ComparedColumn, 8> kCompared{{{&ParameterFigures::bias_pct},
                                                   {&ParameterFigures::sd_pct},
                                                   {&ParameterFigures::mare_pct},
                                                   {&ParameterFigures::coverage95, false},
                                                   {&ParameterFigures::nlpd},
                                                   {&ParameterFigures::crps_pct},
                                                   {&ParameterFigures::limit_pct},
                                                   {&ParameterFigures::ratio_to_limit}}};

/// A parameter's row in both runs.
struct Match {
  Index a, b;
};

/// -1 if the run does not have the parameter.
Index findParameter(const ComparedRun& run, const std::string& name) {
  const auto found =
      std::find_if(run.parameters.begin(), run.parameters.end(),
                   [&](const ParameterSpec& parameter) { return parameter.name.text == name; });
  return found == run.parameters.end() ? -1 : found - run.parameters.begin();
}

std::vector<Match> matchParameters(const ComparedRun& a, const ComparedRun& b) {
  std::vector<Match> matches;
  for (std::size_t p = 0; p < a.parameters.size(); ++p) {
    const Index other = findParameter(b, a.parameters[p].name.text);
    if (other >= 0) {
      matches.push_back({static_cast<Index>(p), other});
    }
  }
  return matches;
}

std::vector<std::string> findOnlyIn(const ComparedRun& run, const ComparedRun& other) {
  std::vector<std::string> names;
  for (const ParameterSpec& parameter : run.parameters) {
    if (findParameter(other, parameter.name.text) < 0) {
      names.push_back(parameter.name.text);
    }
  }
  return names;
}

std::string describeDifference(const std::string& what, const std::string& a, const std::string& b) {
  return what + " is " + a + " in A and " + b + " in B";
}

/// Where the test sets begin to differ; empty if they are the same.
std::string findDifferenceOfSets(const ComparedRun& a, const ComparedRun& b,
                                 const std::vector<Match>& matches) {
  if (a.test.samples.size() != b.test.samples.size()) {
    return describeDifference("the number of test samples", std::to_string(a.test.samples.size()),
                              std::to_string(b.test.samples.size()));
  }
  for (std::size_t i = 0; i < a.test.samples.size(); ++i) {
    const std::string row = std::to_string(i + 1);
    if (a.test.samples[i] != b.test.samples[i]) {
      return describeDifference("test sample number " + row, std::to_string(a.test.samples[i]),
                                std::to_string(b.test.samples[i]));
    }
    for (const Match& match : matches) {
      const double in_a = a.test.truth(match.a, static_cast<Index>(i));
      const double in_b = b.test.truth(match.b, static_cast<Index>(i));
      if (in_a != in_b) {
        return describeDifference(
            fmt::format("the true {} of test sample {}",
                        a.parameters[static_cast<std::size_t>(match.a)].name.text, a.test.samples[i]),
            toText(in_a), toText(in_b));
      }
    }
  }
  return "";
}

SampleTerms calcTerms(const ComparedRun& run, Index p) {
  return calcSampleTerms(run.parameters[static_cast<std::size_t>(p)],
                         takeParameter(run.test.truth, run.test.predictions, run.test.limit_stddev, p));
}

VectorXd calcFigures(const SampleTerms& of) {
  return calcFigureValues(of, of.terms.rowwise().mean(), static_cast<double>(of.terms.cols()));
}

TermSet makeTermSet(const SampleTerms& of) {
  return {of.terms,
          [&of](const VectorXd& mean, double samples) { return calcFigureValues(of, mean, samples); }};
}

ComparedParameter compareParameter(const ComparedRun& a, const ComparedRun& b, const Match& match,
                                   bool paired) {
  const SampleTerms of_a = calcTerms(a, match.a), of_b = calcTerms(b, match.b);
  const VectorXd figures_a = calcFigures(of_a), figures_b = calcFigures(of_b);
  const DifferenceIntervals intervals = paired ? calcPairedIntervals(makeTermSet(of_a), makeTermSet(of_b))
                                               : calcUnpairedIntervals(makeTermSet(of_a), makeTermSet(of_b));
  const ParameterSpec& parameter = a.parameters[static_cast<std::size_t>(match.a)];
  ComparedParameter compared{parameter.name.text, parameter.unit, {}};
  const double unknown = std::nan("");
  for (const ComparedColumn& column : kCompared) {
    const auto found = std::find_if(kFigureColumns.begin(), kFigureColumns.end(),
                                    [&](const FigureColumn& of) { return of.value == column.figure; });
    const Index f = found - kFigureColumns.begin();
    if (!std::isnan(figures_a[f]) || !std::isnan(figures_b[f])) {
      compared.figures.push_back({found->name, figures_a[f], figures_b[f], intervals.difference[f],
                                  column.has_interval ? intervals.lower[f] : unknown,
                                  column.has_interval ? intervals.upper[f] : unknown});
    }
  }
  return compared;
}

}  // namespace

RunComparison compareRuns(const ComparedRun& a, const ComparedRun& b) {
  const std::vector<Match> matches = matchParameters(a, b);
  RunComparison comparison;
  comparison.folder_a = a.folder;
  comparison.folder_b = b.folder;
  comparison.samples_a = static_cast<int>(a.test.samples.size());
  comparison.samples_b = static_cast<int>(b.test.samples.size());
  comparison.difference_of_sets = findDifferenceOfSets(a, b, matches);
  comparison.paired = comparison.difference_of_sets.empty();
  for (const Match& match : matches) {
    comparison.parameters.push_back(compareParameter(a, b, match, comparison.paired));
  }
  comparison.only_a = findOnlyIn(a, b);
  comparison.only_b = findOnlyIn(b, a);
  comparison.keys = compareTrees(a.resolved, b.resolved);
  return comparison;
}

ComparedRun readComparedRun(const std::filesystem::path& folder) {
  requireFinishedRun(folder, {"predictions.csv"});
  const std::string resolved = (folder / "resolved.yaml").string();
  ComparedRun run{folder.string(), loadYaml(resolved), loadExperiment(resolved).model.parameters, {}};
  run.test = readPredictionsFile(folder / "predictions.csv", collectNames(run.parameters));
  std::vector<int> samples = run.test.samples;
  for (const Eigen::Index repeated : run.test.predictions.repeated) {
    samples.push_back(run.test.samples[static_cast<std::size_t>(repeated)]);
  }
  run.test.predictions.mixtures =
      readComponentsFile(folder / "components.csv", collectNames(run.parameters), samples);
  return run;
}

}  // namespace twinmap
