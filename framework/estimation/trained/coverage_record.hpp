#pragma once

#include <Eigen/Core>

namespace twinmap {

/// How many of the 95 % intervals of a run's test samples held the truth.
struct CoverageRecord {
  Eigen::Index tested = 0;  ///< samples; 0 where nobody looked
  Eigen::VectorXd share{};  ///< p, of them

  /// Whether intervals of some parameter hold less than they say: below 0.92, and so few that chance would
  /// leave no more in one of a thousand runs, all parameters together (binomial).
  bool isShort() const;
};

}  // namespace twinmap
