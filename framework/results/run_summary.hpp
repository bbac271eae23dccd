#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/evaluation/exact_posterior.hpp"
#include "framework/evaluation/identifiability.hpp"
#include "framework/evaluation/joint_metrics.hpp"
#include "framework/evaluation/metrics.hpp"
#include "framework/features/feature_block.hpp"
#include "framework/results/gates.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// A sample that could not be simulated, or whose response lacks a feature.
struct FailedSample {
  std::string set;             ///< "train" or "test"
  int sample = 0;              ///< index in its set
  Eigen::VectorXd parameters;  ///< of the sampled box
  std::string reason;
};

/// One search for the hyperparameters of a parameter's process.
struct TrainingStart {
  std::string parameter;
  int start = 0;
  bool best = false;
  double nlml = 0.0;  ///< nats, at its end
  int evaluations = 0;
  bool noise_only = false;  ///< ended where the features say nothing
  std::string stop_reason;
  std::string at_bound;    ///< of the best start: hyperparameters at a bound
  double condition = 0.0;  ///< of the best start: estimated condition number of the covariance matrix
  double jitter = 0.0;  ///< of the best start: added to its diagonal, in units of the standardised parameter
};

/// A hyperparameter of a parameter's process and the bounds of its search.
struct TrainedHyperparameter {
  std::string parameter, name;
  double value = 0.0, lower = 0.0, upper = 0.0;
};

/// Wall time of one stage of a run.
struct StageTime {
  std::string stage;
  double seconds = 0.0;
};

/// How strongly each feature follows each parameter (InformationLimit::relevance).
struct FeatureRelevance {
  std::vector<FeatureInfo> infos;  ///< d
  Eigen::VectorXd noise_stddev;    ///< d, in the features' units
  Eigen::MatrixXd relevance;       ///< d x p
};

/// One test sample's exact posterior beside what the map says.
struct PosteriorComparison {
  int sample = 0;  ///< index in the test set
  ExactPosterior exact;
  Eigen::VectorXd map_mean, map_stddev, limit_stddev;  ///< p; no limit if it is switched off
};

/// How well another way of inferring does on the first `samples` test samples; "map" for the map itself.
struct BaselineSummary {
  std::string method;
  int samples = 0;
  std::vector<ParameterMetrics> metrics;
  double seconds_per_update = 0.0;
  int unconverged = 0;
};

/// What one online update costs: the inference of all parameters from one feature vector.
struct OnlineTimes {
  int updates = 0;  ///< how many were timed
  double median_us = 0.0, p99_us = 0.0;
};

/// Everything that the tables and the report of one run show.
struct RunSummary {
  std::string name;
  std::string description;
  std::vector<ParameterSpec> parameters;  ///< p, updating
  std::vector<ParameterSpec> sampled;     ///< collectSampled
  std::vector<int> axes;  ///< two parameters: axes of the pictures; empty if there is one parameter only
  int train_samples = 0;  ///< requested, failures included
  int test_samples = 0;
  std::vector<int> test_indices;  ///< test samples that could be simulated; columns of what follows
  Eigen::MatrixXd truth;          ///< p x n
  Predictions predictions;        ///< p x n
  Eigen::MatrixXd limit_stddev;   ///< p x n, of the information limit; empty where it is switched off
  std::vector<ParameterMetrics> metrics;
  std::vector<ParameterMetrics> leave_one_out;  ///< of the training samples; empty where not available
  std::vector<std::vector<int>> pit_counts;     ///< one histogram per parameter, kPitBins bins
  JointMetrics joint;
  std::optional<FeatureRelevance> relevance;
  std::optional<Identifiability> identifiability;
  std::vector<PosteriorComparison> posteriors;
  std::vector<BaselineSummary> baselines;
  std::vector<double> nlml;  ///< one per parameter, nats
  std::vector<TrainingStart> training;
  std::vector<TrainedHyperparameter> hyperparameters;
  std::vector<std::string> warnings;
  std::vector<FailedSample> failures;
  int reused_samples = 0;  ///< taken from the store instead of simulated
  std::vector<StageTime> times;
  OnlineTimes online;
  std::vector<GateResult> gates;
};

}  // namespace twinmap
