#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// How many of the 95 % intervals of a run's test samples held the truth.
struct CoverageRecord {
  Eigen::Index tested = 0;  ///< samples; 0 where nobody looked
  Eigen::VectorXd share{};  ///< p, of them

  /// Whether intervals of some parameter hold less than they say: below 0.92, and so few that chance would
  /// leave no more in one of a thousand runs, all parameters together (binomial).
  bool isShort() const;
};

/// How evenly the true values of a run's test samples rank among draws of their posteriors under the
/// surrogate.
struct RankRecord {
  Eigen::Index ranked = 0;    ///< samples; 0 where nobody looked
  Eigen::VectorXd p_value{};  ///< p + 1: of each parameter, then of all together

  /// Quantities whose ranks right posteriors would hardly have (findUneven).
  std::vector<Eigen::Index> listUneven() const;
};

/// Of p-values of several quantities those so small that with all of them right one of a thousand sets names
/// any.
std::vector<Eigen::Index> findUneven(const Eigen::VectorXd& p_value);

}  // namespace twinmap
