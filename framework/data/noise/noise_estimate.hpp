#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// x_k = a_1 x_{k-1} + ... + a_p x_{k-p} + w_k with white w.
struct AutoregressiveModel {
  std::vector<double> coefficients;  ///< a_1 .. a_p; none: white noise
  double innovation_stddev = 0.0;    ///< of w
};

/// The noise of a measured signal that is otherwise constant or drifts in a straight line.
struct NoiseEstimate {
  double mean = 0.0;          ///< of the samples
  double stddev = 0.0;        ///< about the straight line that fits them best
  double stddev_error = 0.0;  ///< its standard error, with the samples' correlation
  AutoregressiveModel model;
  double whiteness = 1.0;  ///< p-value of Ljung and Box's test that what the model leaves is white
};

/// The model of samples of mean 0 by Burg's method, its order, up to `max_order`, of least BIC:
/// n log(variance) + p log(n). `samples`: n > 2 max_order, not all 0. O(n max_order).
AutoregressiveModel fitAutoregression(const Eigen::VectorXd& samples, int max_order);

/// The autocorrelation of a model at lags 0 .. count - 1, from 4000 samples more of its impulse response
/// (accurate for a memory shorter than that). Stationary models only, as Burg's are.
Eigen::VectorXd calcAutocorrelation(const AutoregressiveModel& model, Eigen::Index count);

/// `samples`: equidistant, at least 20, not on one straight line. Throws std::invalid_argument otherwise.
NoiseEstimate estimateNoise(const Eigen::VectorXd& samples);

}  // namespace twinmap
