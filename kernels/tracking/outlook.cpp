#include "kernels/tracking/outlook.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap::tracking {

using Eigen::Index;

Index findSlope(const Model& model, Index parameter) {
  if (!model.drifts[static_cast<std::size_t>(parameter)].has_slope) {
    return -1;
  }
  Index place = model.countParameters();
  for (Index j = 0; j < parameter; ++j) {
    place += model.drifts[static_cast<std::size_t>(j)].has_slope ? 1 : 0;
  }
  return place;
}

const RateFilters* findFilters(const TrackerState& state, Index parameter) {
  const auto found = std::find_if(state.filters.begin(), state.filters.end(),
                                  [&](const RateFilters& one) { return one.parameter == parameter; });
  return found == state.filters.end() ? nullptr : &*found;
}

Outlook calcOutlook(const Tracker& tracker, Index parameter) {
  const Belief belief = tracker.calcBelief();
  Outlook outlook;
  outlook.mean = belief.mean[parameter];
  outlook.stddev = std::sqrt(belief.covariance(parameter, parameter));
  outlook.rate = tracker.calcRates()[parameter];
  if (const Index slope = findSlope(tracker.getModel(), parameter); slope >= 0) {
    outlook.slope = belief.mean[slope];
    outlook.slope_stddev = std::sqrt(belief.covariance(slope, slope));
  }
  if (const RateFilters* filters = findFilters(tracker.getState(), parameter)) {
    const RateEstimate ratio = estimateRate(calcRatePosterior(*filters));
    const TrackerState& state = tracker.getState();
    if (state.interval > 0.0) {
      outlook.rate = ratio.median * ratio.median * state.variances[parameter] / state.interval;
    }
    outlook.rate_log_stddev = 2.0 * ratio.log_stddev;
  }
  return outlook;
}

}  // namespace twinmap::tracking
