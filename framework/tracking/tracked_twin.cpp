#include "framework/tracking/tracked_twin.hpp"

#include <algorithm>

namespace twinmap {

using tracking::Step;

namespace {

void announce(TrackAlarm alarm, TrackPoint& point) {
  if (point.alarms.size() == kKeptAlarms) {
    point.alarms.erase(point.alarms.begin());
  }
  point.alarms.push_back(std::move(alarm));
  ++point.alarm_count;
}

std::vector<std::string> listRivals(const tracking::Change& change, const TrackPoint& point) {
  std::vector<std::string> rivals = findRivals(point.course, change);
  const double since = point.course.empty() ? change.time : point.course.front().time;
  for (const std::string& name : findRecurringRivals(point.alarms, since)) {
    if (std::find(rivals.begin(), rivals.end(), name) == rivals.end()) {
      rivals.push_back(name);
    }
  }
  return rivals;
}

}  // namespace

Step advance(const TrackRecord& record, TrackPoint& point) {
  const double time = record.measurement.time;
  const Step step = point.tracker.advance(record.measurement);
  if (record.estimate.size() > 0) {
    if (point.course.size() == kCourseSamples) {
      point.course.pop_front();
    }
    point.course.push_back({time, record.estimate, record.measurement.variances, record.covariates});
  }
  if (step.change) {
    announce({time, false, *step.change, listRivals(*step.change, point)}, point);
  } else if (step.has_begun_anew) {
    announce({time, true}, point);
  }
  if (step.is_uncalibrated) {
    point.uncalibrated_at = static_cast<double>(point.tracker.getState().count);
  }
  return step;
}

TrackedTwin::TrackedTwin(tracking::Model model, int lag)
    : base_{tracking::Tracker(std::move(model))}, now_(base_), lag_(static_cast<std::size_t>(lag)) {}

TrackedTwin::TrackedTwin(TrackPoint base, std::deque<TrackRecord> window, int lag)
    : base_(std::move(base)), now_(base_), window_(std::move(window)), lag_(static_cast<std::size_t>(lag)) {
  for (const TrackRecord& record : window_) {
    advance(record, now_);
  }
}

const TrackRecord* TrackedTwin::findSame(const TrackRecord& record) const {
  const auto found = std::find_if(window_.begin(), window_.end(),
                                  [&](const TrackRecord& other) { return other.isSame(record); });
  return found == window_.end() ? nullptr : &*found;
}

bool TrackedTwin::isTooLate(const TrackRecord& record) const {
  return base_.tracker.getState().count > 0 && record.isBefore(window_.front());
}

Step TrackedTwin::add(TrackRecord record) {
  Step last;
  if (!isLate(record)) {
    last = advance(record, now_);
    window_.push_back(std::move(record));
  } else {
    const auto place = std::upper_bound(
        window_.begin(), window_.end(), record,
        [](const TrackRecord& one, const TrackRecord& other) { return one.isBefore(other); });
    window_.insert(place, std::move(record));
    now_ = base_;
    for (const TrackRecord& other : window_) {
      last = advance(other, now_);
    }
  }
  while (window_.size() > lag_) {
    advance(window_.front(), base_);
    window_.pop_front();
  }
  return last;
}

}  // namespace twinmap
