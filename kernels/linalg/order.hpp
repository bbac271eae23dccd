#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace twinmap {

/// first, first + 1 ...: `count` of them.
inline std::vector<Eigen::Index> listIndices(Eigen::Index count, Eigen::Index first = 0) {
  std::vector<Eigen::Index> listed(static_cast<std::size_t>(count));
  std::iota(listed.begin(), listed.end(), first);
  return listed;
}

inline std::vector<Eigen::Index> listIndices(std::size_t count) {
  return listIndices(static_cast<Eigen::Index>(count));
}

/// 0 to count - 1, those first that come before others; of those that are alike the lower.
template <class Before>
std::vector<Eigen::Index> sortIndices(Eigen::Index count, const Before& before) {
  std::vector<Eigen::Index> order = listIndices(count);
  std::stable_sort(order.begin(), order.end(), before);
  return order;
}

/// The middle one of some values, the upper of two; 0 of none. O(n).
template <class Value>
Value calcMedian(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.empty() ? Value{0} : *middle;
}

inline double calcMedian(const Eigen::VectorXd& values) {
  return calcMedian(std::vector<double>(values.begin(), values.end()));
}

}  // namespace twinmap
