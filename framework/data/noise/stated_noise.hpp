#pragma once

#include <Eigen/Core>

namespace twinmap {

/// Standard deviations that a measurement states of itself, which go before the experiment's; NaN where it
/// states none; and what its rows have in common.
struct StatedNoise {
  Eigen::VectorXd rows{};      ///< of rows of the response; empty: of none
  Eigen::VectorXd features{};  ///< of features in their linear form; empty: of none

  Eigen::MatrixXd common{};  ///< rows x r: what independent unit normal numbers add; empty: nothing

  bool isGiven() const { return rows.size() > 0 || features.size() > 0; }
};

}  // namespace twinmap
