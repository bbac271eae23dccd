#pragma once

#include "kernels/tracking/crossing.hpp"
#include "kernels/tracking/tracker.hpp"

namespace twinmap::tracking {

/// Of the state: the place of a parameter's slope; -1 of none.
Eigen::Index findSlope(const Model& model, Eigen::Index parameter);

/// Of a parameter whose rate is unknown; else null.
const RateFilters* findFilters(const TrackerState& state, Eigen::Index parameter);

/// What the tracker knows of a parameter's level and of how it goes on.
Outlook calcOutlook(const Tracker& tracker, Eigen::Index parameter);

}  // namespace twinmap::tracking
