#pragma once

#include <functional>

#include "framework/experiment/prepare_data.hpp"
#include "framework/features/feature_transform.hpp"
#include "framework/inverse_map/predictions.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/sensitivity/feature_sensitivities.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A trained map of any kind.
struct EvaluatedMap {
  /// Features (d x n) and known inputs (q x n) -> parameters (p x n each).
  std::function<Predictions(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs)> predict;
  Eigen::MatrixXd residual_correlation;  ///< p x p, of the errors of a sample
  FeatureTransform transform;            ///< what a linear regression is to see of the features
};

/// What the evaluation of a map looks at.
struct EvaluationContext {
  const ExperimentSpec& experiment;
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const PreparedData& data;
  const EvaluatedMap& map;
  LocalModelSource local_models;
  int threads = 1;
};

/// An evaluation, with the warnings and times of its stages.
struct MapEvaluation {
  Evaluation evaluation;
  StageNotes notes;
};

/// Infers the test samples and finds out how good that is: errors and calibration, and, where the experiment
/// asks for them, information limit, exact posteriors and baselines.
MapEvaluation evaluateMap(const EvaluationContext& context);

/// What follows from predictions of the test samples alone: metrics, joint metrics and PIT counts.
/// `limit_stddev`: p x n, or empty.
Evaluation evaluatePredictions(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                               const Predictions& predictions, const Eigen::MatrixXd& limit_stddev,
                               const Eigen::MatrixXd& residual_correlation);

}  // namespace twinmap
