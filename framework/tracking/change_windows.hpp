#pragma once

#include <deque>
#include <vector>

#include "framework/tracking/tracked_twin.hpp"

namespace twinmap {

/// Of each side of a change, so many measurements are held against it.
constexpr std::size_t kChangeWindows = 6;

/// Measurements before and after a change, in order.
struct ChangeWindows {
  std::vector<const TrackRecord*> before, after;
};

/// Those among the records (in order) that say something of the machine, of the trial that the last one
/// records. Four on each side are the nearest to the change, between which a machine's motion hardly differs.
/// The others are as far as the fastest walk takes for one standard deviation of a measurement, 40 at most.
/// What lies apart from the others of its side is left out, as one measurement may be bad.
ChangeWindows chooseChangeWindows(const std::deque<TrackRecord>& records, const TrackPoint& now,
                                  double change);

}  // namespace twinmap
