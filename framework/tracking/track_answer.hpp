#pragma once

#include "framework/base/json/json_fwd.hpp"
#include "framework/experiment/tracking_spec.hpp"
#include "framework/tracking/track_space.hpp"
#include "framework/tracking/tracked_twin.hpp"

namespace twinmap {

/// What the texts of a tracked twin are made of.
struct TrackView {
  const std::vector<ParameterSpec>& parameters;
  const TrackSpace& space;
  const TrackingSpec* tracking;                           ///< null: none
  const std::deque<AlarmDiagnosis>* diagnoses = nullptr;  ///< null: none
};

/// The belief at a point: "measurements", "time", "status" (ok or uncalibrated), "parameters" by name. Each
/// has mean, sd, lower, upper, unit, "walk" (sd over an interval, with its own) and "slope". Then
/// "covariance", "follows", "forecast" of limits.
Json makeTrackState(const TrackPoint& point, const TrackView& view);

/// The alarms behind the first `skipped` of all: parameter, time, size, sd, probability. "drift_or_model" has
/// rivals, the test that would tell, and the diagnosis of the recordings before and after it.
Json makeTrackAlarms(const TrackPoint& point, long long skipped, const TrackView& view);

}  // namespace twinmap
