#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/parameter_figures.hpp"

namespace twinmap {

struct ParameterMetrics : ParameterFigures {
  ParameterFigures se;  ///< Monte Carlo standard error of each figure, by the jackknife over the samples
  int samples = 0;      ///< behind the figures
};

/// Metrics of each parameter, in order. `truth` is p x n, n >= 2 (3 for standard errors). `limit_stddev` is
/// p x n, in the parameters' units, or empty where the limit is switched off; a NaN in a row makes the
/// parameter's limit NaN. `draws`: columns j + i n / draws are draws of one sample, which standard errors
/// leave out together. O(p n).
std::vector<ParameterMetrics> calcMetrics(const std::vector<ParameterSpec>& parameters,
                                          const Eigen::MatrixXd& truth, const Estimates& predictions,
                                          const Eigen::MatrixXd& limit_stddev = {}, int draws = 1);

struct ParameterSamples;

/// Of one parameter, or of what is shown like one. Needs 3 samples for standard errors.
ParameterMetrics calcMetrics(const ParameterSpec& parameter, const ParameterSamples& samples, int draws = 1);

}  // namespace twinmap
