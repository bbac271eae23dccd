#include "framework/tracking/change_windows.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/interval_factor.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Records = std::vector<const TrackRecord*>;

/// How many measurements a walk takes for one standard deviation of a measurement.
std::size_t calcReach(const tracking::Tracker& tracker) {
  const tracking::TrackerState& state = tracker.getState();
  const double ratio = (state.interval * tracker.calcRates().array() / state.variances.array()).maxCoeff();
  const double reach = std::min(1.0 / ratio, static_cast<double>(tracking::kChangeWindow));
  return std::isfinite(reach) ? std::max(kChangeWindows, static_cast<std::size_t>(reach))
                              : tracking::kChangeWindow;
}

/// Median of a number of each record.
template <class Number>
double calcMedianOf(const Records& records, const Number& number) {
  VectorXd numbers(static_cast<Index>(records.size()));
  for (std::size_t i = 0; i < records.size(); ++i) {
    numbers[static_cast<Index>(i)] = number(*records[i]);
  }
  return calcMedian(numbers);
}

/// Without those that lie more than five deviations from the median of a parameter.
Records leaveApart(Records records) {
  constexpr double kApart = 5.0;  // standard deviations
  if (records.size() < 3) {
    return records;
  }
  for (Index j = 0; j < records.front()->estimate.size(); ++j) {
    const double middle = calcMedianOf(records, [&](const TrackRecord& one) { return one.estimate[j]; });
    const auto calcOff = [&](const TrackRecord& one) { return std::abs(one.estimate[j] - middle); };
    const double scatter = calcMedianOf(records, calcOff) / kNormal50;
    records.erase(std::remove_if(records.begin(), records.end(),
                                 [&](const TrackRecord* one) {
                                   const double own = one->measurement.variances[j];
                                   return calcOff(*one) > kApart * std::max(scatter, std::sqrt(own));
                                 }),
                  records.end());
  }
  return records;
}

/// Of more than six, in order: the four that are nearest to the change, the farthest, and the one in the
/// middle. The nearest ones are the last of those before it.
Records spread(const Records& records, bool is_before) {
  const std::size_t count = records.size();
  if (count <= kChangeWindows) {
    return records;
  }
  const std::size_t last = count - 1;
  Records chosen{records[0], records[is_before ? (last - 3) / 2 : (last + 4) / 2], records[last]};
  const auto near = is_before ? records.end() - 4 : records.begin() + 1;
  chosen.insert(is_before ? chosen.end() - 1 : chosen.begin() + 1, near, near + 3);
  return chosen;
}

}  // namespace

ChangeWindows chooseChangeWindows(const std::deque<TrackRecord>& records, const TrackPoint& now,
                                  double change) {
  ChangeWindows windows;
  for (const TrackRecord& record : records) {
    if (record.estimate.size() > 0 && record.trial == records.back().trial) {
      (record.measurement.time < change ? windows.before : windows.after).push_back(&record);
    }
  }
  const std::size_t reach = calcReach(now.tracker);
  if (windows.before.size() > reach) {
    windows.before.erase(windows.before.begin(), windows.before.end() - static_cast<std::ptrdiff_t>(reach));
  }
  windows.after.resize(std::min(windows.after.size(), reach));
  return {spread(leaveApart(windows.before), true), spread(leaveApart(windows.after), false)};
}

}  // namespace twinmap
