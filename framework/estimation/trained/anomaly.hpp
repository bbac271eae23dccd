#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// A run of residuals that belong together, such as the samples of one output in the order of time.
struct ResidualRun {
  Eigen::Index first = 0, count = 0;
};

/// The worst stretch of a residual.
struct Anomaly {
  double score = 0.0;  ///< a standard normal deviate, to about a tenth
  Eigen::Index first = 0, count = 0;
};

/// Looks for a disturbance that lasts a while, which the sum over all residuals may hide: of all stretches of
/// 1, 2, 4, 8 ... neighbours within a run, starting at every half of their length, the one whose sum of
/// squares is least likely for independent standard normal residuals, by Wilson and Hilferty's approximation
/// (PNAS 17, 1931). Cost: 3 flops per residual and length.
Anomaly findAnomaly(const Eigen::VectorXd& residual, const std::vector<ResidualRun>& runs);

}  // namespace twinmap
