#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/data/reduction/feature_transform.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {

/// Another way to infer the parameters of the first test samples.
struct BaselineResult {
  std::string method;  ///< "prior_mean", "linear_regression", "least_squares"
  int samples = 0;     ///< the first test samples
  Estimates predictions;
  double seconds_per_update = 0.0;  ///< wall time of one sample on one thread
  int unconverged = 0;              ///< samples whose search did not end at a minimum
};

/// Mean and standard deviation of the prior within the bounds, whatever was measured.
Estimates predictPriorMean(const ModelSpec& model, Eigen::Index samples);

/// Runs one baseline on the test samples. `transform`: what a linear regression sees of the features. Least
/// squares searches all that is unknown (search.hpp) from one start, with the inputs of each sample; features
/// count in units of their noise, the box as a normal distribution, and no other priors; a simulation that
/// fails at the start leaves the start with the box's half-widths. All but the time is independent of the
/// threads.
BaselineResult runBaseline(const BaselineSpec& spec, const Study& study, const LabelledSets& samples,
                           const FeatureTransform& transform);

}  // namespace twinmap
