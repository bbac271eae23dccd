#include "framework/data/measurement/row_order.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace twinmap {

using Eigen::Index;

RowOrder sortRows(const Eigen::VectorXd& times) {
  RowOrder order;
  for (Index i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i])) {
      order.rows.push_back(i);
    }
  }
  if (const auto without = times.size() - static_cast<Index>(order.rows.size()); without > 0) {
    order.remarks.push_back(fmt::format("{} rows without a time", without));
  }
  const auto before = [&](Index a, Index b) { return times[a] < times[b]; };
  if (!std::is_sorted(order.rows.begin(), order.rows.end(), before)) {
    std::stable_sort(order.rows.begin(), order.rows.end(), before);
    order.remarks.emplace_back("rows are not in the order of their times: sorted");
  }
  const auto same = [&](Index a, Index b) { return times[a] == times[b]; };
  const auto end = std::unique(order.rows.begin(), order.rows.end(), same);
  if (const auto doubled = order.rows.end() - end; doubled > 0) {
    order.remarks.push_back(fmt::format("{} rows with the time of another: the first is taken", doubled));
  }
  order.rows.erase(end, order.rows.end());
  return order;
}

}  // namespace twinmap
