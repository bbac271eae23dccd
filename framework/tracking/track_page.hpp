#pragma once

#include <string>

#include "framework/tracking/track_answer.hpp"
#include "framework/tracking/track_history.hpp"

namespace twinmap {

/// A page (HTML, complete in itself, without scripts). It draws each parameter over time with its 95 % bands,
/// filtered and smoothed, changes and limits. Tables have alarms with their rivals, the forecast, and the
/// last measurements with their statuses. point: behind the course.
std::string makeTrackPage(const std::string& name, const TrackCourse& course, const TrackPoint& point,
                          const TrackView& view);

}  // namespace twinmap
