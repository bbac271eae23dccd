#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/yaml/compare_trees.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/store/predictions_file.hpp"

namespace twinmap {

/// What two runs are compared by.
struct ComparedRun {
  std::string folder;
  YamlNode resolved;  ///< resolved.yaml
  std::vector<ParameterSpec> parameters;
  StoredPredictions test;
};

/// Reads a run's folder. Throws ExperimentError naming the folder if it is not that of a finished run, or
/// that of a sweep.
ComparedRun readComparedRun(const std::filesystem::path& folder);

/// A figure of metrics.csv in both runs, with the 95 % interval of the difference b - a (coverages have
/// none).
struct ComparedFigure {
  std::string name;
  double a, b;
  double difference, lower, upper;  ///< NaN where not known
};

struct ComparedParameter {
  std::string name, unit;
  std::vector<ComparedFigure> figures;
};

/// Two runs side by side.
struct RunComparison {
  std::string folder_a, folder_b;
  int samples_a = 0, samples_b = 0;  ///< test samples
  bool paired = false;               ///< the test sets are the same
  std::string difference_of_sets;    ///< the first difference of the test sets, where they are not the same
  std::vector<ComparedParameter> parameters;  ///< those that both have, in the order of a
  std::vector<std::string> only_a, only_b;    ///< parameters that one run has
  std::vector<KeyDifference> keys;            ///< of resolved.yaml
};

/// Compares bias, sd, mean absolute relative error, coverage, NLPD, CRPS and, where it is known, the limit
/// and the ratio to it, as calcMetrics() defines them, for the parameters that both runs have. Where both
/// inferred the same samples (indices and true values, bit for bit) intervals are those of pairs, else of
/// independent sets (paired_bootstrap.hpp); 10000 resamples, fixed seed. A coverage counts samples and has no
/// interval: the few samples in which two runs disagree are too few for a bootstrap.
RunComparison compareRuns(const ComparedRun& a, const ComparedRun& b);

/// For people: a table of the figures, what differs in the experiments, and what the intervals are.
std::string makeComparisonText(const RunComparison& comparison);

/// Columns parameter, unit, figure, a, b, difference, lower, upper, paired (1 or 0); empty where not
/// known.
std::string makeComparisonCsv(const RunComparison& comparison);

/// All of it; numbers that are not known are null.
std::string makeComparisonJson(const RunComparison& comparison);

}  // namespace twinmap
