#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace twinmap {

/// Rows in the order of their times.
struct RowOrder {
  std::vector<Eigen::Index> rows;
  std::vector<std::string> remarks;  ///< what had to be done, a phrase each
};

/// The rows that have a time (finite), sorted by it, the first of several with the same time kept. O(n log
/// n).
RowOrder sortRows(const Eigen::VectorXd& times);

}  // namespace twinmap
