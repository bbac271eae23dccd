#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/analysis/curve_estimates.hpp"
#include "framework/analysis/derived_metrics.hpp"
#include "framework/analysis/identifiability.hpp"
#include "framework/analysis/joint_metrics.hpp"
#include "framework/analysis/metrics.hpp"
#include "framework/analysis/rank_calibration.hpp"
#include "framework/base/log/stage_notes.hpp"
#include "framework/data/features/feature_block.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/refined/refined.hpp"
#include "framework/estimation/ridges/identified_combinations.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/results/gates.hpp"

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

/// What the cross-validation of a map found that scales its standard deviations by it; p parameters.
struct CrossValidation {
  Eigen::VectorXd coverage95;    ///< of its own 95 % intervals
  Eigen::VectorXd stddev_scale;  ///< by which standard deviations were multiplied
  double log_density = 0.0;      ///< mean log joint density of the true parameters after that, in their units
  std::string status;            ///< "ok", "estimator_limited"
  Eigen::VectorXd limit_ratio;   ///< predicted: standard deviations over what the measurements allow
  int half = 0, all = 0;         ///< simulations compared; 0 where they were too few
  Eigen::VectorXd error_ratio;   ///< errors with all simulations over those with half of them; empty likewise
  IntervalFactors interval_factors{};  ///< half widths of intervals after that
};

/// How well chains know a quantity (markov::Convergence).
struct SampledQuantity {
  std::string name;
  double r_hat = 0.0, effective_draws = 0.0;
};

/// How well the chains know a network whose weights were sampled.
struct SampledChains {
  std::vector<SampledQuantity> quantities;  ///< the parameters, then the density
  int chains = 0, draws = 0;                ///< of each chain
  int divergences = 0, cut = 0;             ///< trajectories of all draws that ran away, or did not turn back
  double acceptance = 0.0;                  ///< mean
  int weights = 0;                          ///< numbers that were sampled
};

/// How the inverse map was trained.
struct TrainingSummary {
  std::vector<ParameterMetrics> leave_one_out;  ///< of the training samples; empty where not available
  std::vector<double> nlml;                     ///< one per parameter, nats; NaN of a map without
  std::vector<TrainingStart> starts;
  std::vector<TrainedHyperparameter> hyperparameters;
  std::optional<CrossValidation> cross_validation;
  std::optional<SampledChains> chains{};
};

/// How strongly each feature follows each parameter (InformationLimit::relevance).
struct FeatureRelevance {
  std::vector<FeatureInfo> infos;  ///< d
  Eigen::VectorXd noise_stddev;    ///< d, in the features' units
  Eigen::MatrixXd relevance;       ///< d x p
};

/// One test sample's exact posterior beside what the map says.
struct PosteriorComparison {
  int sample = 0;                ///< index in the test set
  Eigen::VectorXd mean, stddev;  ///< p, of the posterior; NaN where it is not reliable
  double effective_sample_size = 0.0;
  int simulations = 0;
  Eigen::VectorXd map_mean, map_stddev, limit_stddev;  ///< p; no limit if it is switched off
};

/// How well calibrated the posteriors of the test samples are.
struct PosteriorCalibration {
  int measurements = 0;   ///< whose posterior is reliable
  int unreliable = 0;     ///< left out
  RankCalibration ranks;  ///< of each parameter, then of all together
};

/// How well another way of inferring does on the first `samples` test samples; "map" for the map itself.
struct BaselineSummary {
  std::string method;
  int samples = 0;
  std::vector<ParameterMetrics> metrics;
  double seconds_per_update = 0.0;
  int unconverged = 0;
};

/// How well a method infers the test samples.
struct MethodSummary {
  std::string method;  ///< "gp", "surrogate", "network", "refined", "posterior", "sampled"
  Eigen::Index samples = 0, accepted = 0;
  int median_simulations = 0;             ///< of a measurement
  std::vector<ParameterMetrics> metrics;  ///< of the accepted
  /// Of refined estimates, where exact posteriors are known: the share that differs from them by more than .3
  /// of their standard deviations.
  std::optional<double> apart_from_posterior{};
};

/// What `twinmap infer` says of a test sample: by which method, and with which statuses.
struct TestAnswer {
  std::string method;  ///< Estimate::getMethod()
  std::vector<std::string> statuses;

  bool has(const std::string& status) const {
    return std::find(statuses.begin(), statuses.end(), status) != statuses.end();
  }
};

/// The answers of `twinmap infer` that tables judge, where those are refined.
struct AnswerSummary {
  std::vector<TestAnswer> answers;  ///< n
  /// n, how many samples each stands for: 0 of those that need a posterior and were not sampled.
  Eigen::VectorXd weights;
  std::size_t needing = 0, sampled = 0;  ///< of the posterior on the simulator

  /// The share of the test samples whose answer fulfils a condition.
  template <class Condition>
  double calcShare(const Condition& condition) const {
    double share = 0.0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      share += condition(answers[i]) ? weights[static_cast<Eigen::Index>(i)] : 0.0;
    }
    return share / static_cast<double>(answers.size());
  }
  /// The share of which anything is said but "ok".
  double calcNotOk() const {
    return calcShare([](const TestAnswer& answer) { return !answer.statuses.empty() && !answer.has("ok"); });
  }
};

/// What one online update costs: the inference of all parameters from one feature vector.
struct OnlineTimes {
  int updates = 0;  ///< how many were timed
  double median_us = 0.0, p99_us = 0.0;
};

/// One of several maps that learnt from the same samples, without refinement.
struct MapComparison {
  std::string name;
  std::vector<ParameterMetrics> metrics;
  JointMetrics joint;
  double training_seconds = 0.0;
  OnlineTimes online;
  std::uintmax_t bytes = 0;  ///< of the file that infers
};

/// How well the inverse map infers the test samples: p parameters, n samples that could be simulated.
struct Evaluation {
  Eigen::MatrixXd truth;         ///< p x n
  Estimates predictions;         ///< p x n
  Eigen::MatrixXd limit_stddev;  ///< p x n, of the information limit; empty where there is none
  std::vector<ParameterMetrics> metrics;
  std::vector<std::vector<int>> pit_counts;  ///< one histogram per parameter, kPitBins bins
  JointMetrics joint;
  std::optional<FeatureRelevance> relevance;
  std::optional<Identifiability> identifiability;
  std::vector<Ridge> ridges;  ///< parameters of which combinations alone are determined
  std::vector<PosteriorComparison> posteriors;
  std::optional<PosteriorCalibration> calibration;
  std::vector<BaselineSummary> baselines;
  std::vector<Refined> refined;          ///< n; empty where nothing was refined
  std::optional<AnswerSummary> answers;  ///< none where nothing was refined
  std::vector<MethodSummary> methods;    ///< empty where nothing was refined
  std::vector<MapComparison> maps;
  std::optional<DerivedEvaluation> derived;  ///< where the experiment derives quantities
  CurveEstimates curves;                     ///< of some samples, where the model has curves
  Eigen::VectorXd prior_stddev{};            ///< p, within the bounds; empty where all are uniform
};

/// Everything that the tables of one run show.
struct RunSummary {
  std::vector<ParameterSpec> parameters;  ///< p, updating
  std::vector<int> test_indices;          ///< test samples that could be simulated; columns of the evaluation
  TrainingSummary training;
  Evaluation evaluation;
  std::vector<FailedSample> failures;
  int reused_samples = 0;  ///< taken from the store instead of simulated
  OnlineTimes online;
  StageNotes notes;  ///< of all stages, in their order
  std::vector<GateResult> gates;
};

}  // namespace twinmap
