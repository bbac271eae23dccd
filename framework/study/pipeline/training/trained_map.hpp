#pragma once

#include <functional>
#include <string>

#include "framework/data/reduction/feature_transform.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/results/run_summary.hpp"

namespace twinmap {

/// Features (d x n) and known inputs (q x n) -> parameters (p x n each).
using Predictor = std::function<Estimates(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs)>;

/// A trained map of any kind.
struct TrainedMap {
  std::string name;  ///< as methods.csv has it: "gp", "surrogate", "network"
  Predictor predict;
  Eigen::MatrixXd residual_correlation;  ///< p x p, of the errors of a sample
  FeatureTransform transform;            ///< what a linear regression is to see of the features
  TrainingSummary summary;
  StageNotes notes;
  OnlineModel online;
};

}  // namespace twinmap
