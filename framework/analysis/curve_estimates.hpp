#pragma once

#include <string>
#include <vector>

#include "framework/analysis/derived_metrics.hpp"

namespace twinmap {

/// What estimates say of the curves of a model, at points over their ranges.
struct CurveEstimates {
  std::vector<std::string> curves;  ///< of each row of `values` its curve
  std::vector<double> arguments;    ///< and its argument
  DerivedEvaluation values;         ///< points of all curves x the first few samples
};

/// At most this many samples are drawn.
inline constexpr Eigen::Index kDrawnCurves = 3;

/// Of the curves that follow from the updating parameters, at 41 points of each, as quantities that are
/// derived from the first kDrawnCurves estimates. `truth`: p x n. Empty where there are none. Cost: some 10
/// ms a curve and sample.
CurveEstimates estimateCurves(const ExperimentSpec& experiment, const Eigen::MatrixXd& truth,
                              const Estimates& estimates);

}  // namespace twinmap
