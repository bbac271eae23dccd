#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/analysis/linear_map.hpp"
#include "framework/analysis/metrics.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Another way to infer the parameters of the first test samples.
struct BaselineResult {
  std::string method;  ///< "prior_mean", "linear_regression", "least_squares"
  int samples = 0;     ///< the first test samples
  Predictions predictions;
  double seconds_per_update = 0.0;  ///< wall time of one sample on one thread
  int unconverged = 0;              ///< samples whose search did not end at a minimum
};

/// The middle of the box and a uniform distribution's standard deviation, whatever was measured.
Predictions predictPriorMean(const std::vector<ParameterSpec>& parameters, Eigen::Index samples);

/// What the baselines of an experiment need besides its training and test samples.
struct BaselineContext {
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const FeatureTransform& transform;             ///< that of the map, for the linear regression
  const std::vector<ParameterSpec>& parameters;  ///< p, updating
  const std::vector<ParameterSpec>& unknown;     ///< u, those and the nuisance parameters
  int threads = 1;
};

/// Runs one baseline. Least squares searches all that is unknown, with the inputs of each sample; it compares
/// features in units of their mean noise (labelled sets' covariance); its standard deviations are those of
/// the Fisher information at its solution, with the box as in calcLimitCovariance. All but the time is
/// independent of the threads.
BaselineResult runBaseline(const BaselineSpec& spec, const BaselineContext& context,
                           const LabelledFeatures& train, const LabelledFeatures& test);

}  // namespace twinmap
