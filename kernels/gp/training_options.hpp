#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "kernels/gp/model.hpp"
#include "kernels/gp/stop.hpp"

namespace twinmap::gp {

/// Bounds as multiples of a scale taken from the data.
struct RelativeBounds {
  double lower;
  double upper;
};

/// log(l / median distance) ~ N(log_mean, log_stddev^2); its negative log density is added to the NLML.
struct LengthScalePrior {
  double log_mean = 0.0;    ///< 0: the median distance itself
  double log_stddev = 2.0;  ///< 2: a factor of 7, weak enough to yield to a few dozen samples
};

/// Where one search begins, and how the NLML curves there in log-hyperparameters (TrainingResult::curvature).
struct WarmStart {
  Hyperparameters hyperparameters;
  Eigen::MatrixXd curvature;
};

struct TrainingOptions {
  /// Local searches per target; the best NLML wins. 2: from the median distance with noise start_noise, and
  /// from far off it (with several groups: from the optimum of a shared length scale). They found the best of
  /// 8 starts on the two-beam targets of 20 seeds, and of seed 1 from 16 other first starts.
  int starts = 2;
  /// One per target: a single search from here (polish()) replaces the starts. For hyperparameters known from
  /// similar data.
  std::vector<WarmStart> warm_starts;
  /// Whether the results have their curvature, for warm starts: k + 1 evaluations more a target.
  bool curvature = false;
  /// NLML + gradient evaluations per start. A start takes some 20 to 40; 200 ends only the hopeless.
  int max_evaluations = 200;
  /// A start ends when a step gains less than this many nats. 1e-4 would change no prediction visibly; 1e-6
  /// costs one evaluation more.
  double tolerance = 1e-6;
  /// Noise stddev of the first start over the target's: large enough to see the signal through, small enough
  /// not to fall into the noise-only optimum.
  double start_noise = 0.3;
  /// Length scales of the first start over the median distance between samples.
  double start_length_scale = 1.0;
  /// Times the median distance between samples (overall, or of the group where that is further out).
  RelativeBounds length_scale{1e-2, 1e3};
  /// Times the target's stddev. A smooth map seen over a small part of its length scale needs a large signal.
  RelativeBounds signal_stddev{1e-2, 1e3};
  /// Times the target's stddev. The lower bound keeps K's condition number below 1 / epsilon.
  RelativeBounds noise_stddev{1e-5, 3.0};
  /// Absolute; above 1000 the rational quadratic is the squared exponential to rounding.
  RelativeBounds shape{1e-2, 1e3};
  /// Times the target's stddev over the inputs' root mean square distance from their mean.
  RelativeBounds linear_stddev{1e-4, 1e3};
  /// None: maximum likelihood, as in the paper. Worth setting with many length scales and few samples.
  std::optional<LengthScalePrior> length_scale_prior;
  /// Targets x starts run in parallel; the result does not depend on the number.
  int threads = 1;
  /// Once true, training ends with Stopped as soon as the evaluations under way are done: n^3 flops each.
  StopFlag stop = nullptr;
};

}  // namespace twinmap::gp
