#include "framework/results/comparison/run_comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/analysis/metrics.hpp"
#include "framework/analysis/paired_bootstrap.hpp"
#include "framework/analysis/sample_terms.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/store/finished_run.hpp"

namespace twinmap {
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
