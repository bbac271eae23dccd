#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/inverse_map/predictions.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// How well one parameter is inferred over a test set. Relative errors are e = (inferred - true) / true, or
/// relative to upper - lower where the parameter says so; z = (inferred - true) / stddev.
struct ParameterMetrics {
  double bias_pct = 0.0;    ///< 100 mean(e)
  double sd_pct = 0.0;      ///< 100 sd(e), with 1/(n-1)
  double mare_pct = 0.0;    ///< 100 mean|e|
  double coverage95 = 0.0;  ///< fraction of samples with |z| below the normal 95 % quantile (two-sided)
  double coverage90 = 0.0;
  double coverage50 = 0.0;
  double stddev_pct = 0.0;  ///< 100 times the root mean square of stddev / |true|: the sd the map claims
  double z_mean = 0.0;
  double z_sd = 0.0;  ///< 1 where the claimed sd is honest
  double nlpd = 0.0;  ///< mean negative log predictive density, in the parameter's unit
  int samples = 0;    ///< test samples that could be simulated
};

/// Metrics of each parameter, in order. `truth` is p x n, n >= 2. O(p n).
std::vector<ParameterMetrics> calcMetrics(const std::vector<ParameterSpec>& parameters,
                                          const Eigen::MatrixXd& truth, const Predictions& predictions);

}  // namespace twinmap
