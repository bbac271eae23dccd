#include "framework/tracking/tracked_twin.hpp"

#include <algorithm>
#include <limits>

#include "kernels/linalg/order.hpp"

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

std::vector<std::string> listRivals(const std::vector<Eigen::Index>& parameters, double change,
                                    const TrackPoint& point) {
  std::vector<std::string> rivals = findRivals(point.course, parameters, change);
  const double since = point.course.empty() ? change : point.course.front().time;
  for (const std::string& name : findRecurringRivals(point.alarms, since)) {
    if (std::find(rivals.begin(), rivals.end(), name) == rivals.end()) {
      rivals.push_back(name);
    }
  }
  return rivals;
}

/// The time of the first of those that did not fit, behind which all begins anew.
double findBegin(const std::deque<CourseSample>& course) {
  int left = tracking::kRunOfBad;
  for (auto sample = course.rbegin(); sample != course.rend(); ++sample) {
    left -= (sample->variances.array() < std::numeric_limits<double>::infinity()).any() ? 1 : 0;
    if (left == 0) {
      return sample->time;
    }
  }
  return course.front().time;
}

TrackAlarm makeAlarmOfSeveral(double announced, const TrackPoint& point) {
  TrackAlarm alarm{announced, true};
  alarm.change.time = findBegin(point.course);
  alarm.rivals =
      listRivals(listIndices(point.tracker.getModel().countParameters()), alarm.change.time, point);
  return alarm;
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
    announce({time, false, *step.change, listRivals({step.change->parameter}, step.change->time, point)},
             point);
  } else if (step.has_begun_anew) {
    announce(makeAlarmOfSeveral(time, point), point);
  }
  if (step.is_uncalibrated) {
    point.uncalibrated_at = static_cast<double>(point.tracker.getState().count);
  }
  return step;
}

TrackedTwin::TrackedTwin(tracking::Model model, int lag)
    : base_{tracking::Tracker(std::move(model))}, now_(base_), lag_(static_cast<std::size_t>(lag)) {}

TrackedTwin::TrackedTwin(TrackPoint base, std::deque<TrackRecord> window, int lag,
                         std::deque<AlarmDiagnosis> diagnoses)
    : base_(std::move(base)),
      now_(base_),
      window_(std::move(window)),
      lag_(static_cast<std::size_t>(lag)),
      diagnoses_(std::move(diagnoses)) {
  for (const TrackRecord& record : window_) {
    advance(record, now_);
  }
}

const TrackRecord* TrackedTwin::findSame(const TrackRecord& record) const {
  const auto found = std::find_if(window_.begin(), window_.end(),
                                  [&](const TrackRecord& other) { return other.isSame(record); });
  return found == window_.end() ? nullptr : &*found;
}

const TrackAlarm* TrackedTwin::findUndiagnosed() const {
  const TrackAlarm* last = now_.alarms.empty() ? nullptr : &now_.alarms.back();
  const bool is_done =
      last == nullptr || std::any_of(diagnoses_.begin(), diagnoses_.end(),
                                     [&](const AlarmDiagnosis& one) { return one.isOf(*last); });
  return is_done ? nullptr : last;
}

void TrackedTwin::note(AlarmDiagnosis diagnosis) {
  if (diagnoses_.size() == kKeptAlarms) {
    diagnoses_.pop_front();
  }
  diagnoses_.push_back(std::move(diagnosis));
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
