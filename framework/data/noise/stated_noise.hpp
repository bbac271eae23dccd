#pragma once

#include <Eigen/Core>

namespace twinmap {

/// Standard deviations that a measurement states of itself, which go before the experiment's; NaN where it
/// states none.
struct StatedNoise {
  Eigen::VectorXd rows{};      ///< of rows of the response; empty: of none
  Eigen::VectorXd features{};  ///< of features in their linear form; empty: of none

  bool isGiven() const { return rows.size() > 0 || features.size() > 0; }
};

}  // namespace twinmap
