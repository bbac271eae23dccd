#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The values of one variable in units of their standard deviation, and their order.
struct RankedValues {
  Eigen::VectorXd values;           ///< n; empty for a constant, which tells nothing
  std::vector<double> sorted;       ///< the same, ascending
  std::vector<Eigen::Index> order;  ///< sorted[i] is values[order[i]]
};

RankedValues rankValues(const Eigen::VectorXd& values);

/// Mutual information of two variables from n samples of both, in nats, at least 0: the estimator of Kraskov,
/// Stoegbauer and Grassberger (2004, the first), from the distance to the nearest `neighbours` (below n) in
/// the larger of the two differences. 0 for a constant. Cost: some n^1.5 operations, n^2 at most.
double calcMutualInformation(const RankedValues& a, const RankedValues& b, int neighbours);

}  // namespace twinmap
