#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/evaluation/metrics.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// A sample that could not be simulated.
struct FailedSample {
  std::string set;  ///< "train" or "test"
  int sample = 0;   ///< index in its set
  Eigen::VectorXd parameters;
  std::string reason;
};

/// Wall time of one stage of a run.
struct StageTime {
  std::string stage;
  double seconds = 0.0;
};

/// Everything that the tables and the report of one run show.
struct RunSummary {
  std::string name;
  std::string description;
  std::vector<ParameterSpec> parameters;
  std::vector<int> axes;  ///< two parameters: axes of the pictures; empty if there is one parameter only
  int train_samples = 0;  ///< requested, failures included
  int test_samples = 0;
  std::vector<int> test_indices;  ///< test samples that could be simulated; columns of what follows
  Eigen::MatrixXd truth;          ///< p x n
  Predictions predictions;        ///< p x n
  std::vector<ParameterMetrics> metrics;
  std::vector<double> nlml;  ///< one per parameter, nats
  std::vector<std::string> warnings;
  std::vector<FailedSample> failures;
  std::vector<StageTime> times;
};

}  // namespace twinmap
