#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/features/feature_transform.hpp"
#include "framework/inverse_map/predictions.hpp"
#include "framework/online/online_model.hpp"
#include "framework/results/run_summary.hpp"

namespace twinmap {

/// Features (d x n) and known inputs (q x n) -> parameters (p x n each).
using Predictor = std::function<Predictions(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs)>;

/// A trained map of any kind.
struct TrainedMap {
  std::string name;  ///< as methods.csv has it: "inverse_map", "surrogate", "network"
  Predictor predict;
  Eigen::MatrixXd residual_correlation;  ///< p x p, of the errors of a sample
  FeatureTransform transform;            ///< what a linear regression is to see of the features
  TrainingSummary summary;
  StageNotes notes;
  OnlineModel online;
  GpMap exact;  ///< what online was compressed from; without processes where it is of another kind
};

}  // namespace twinmap
