#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "framework/tracking/track_record.hpp"
#include "kernels/tracking/tracker.hpp"

namespace twinmap {

/// A change that was announced.
struct TrackAlarm {
  double announced = 0.0;      ///< time of the measurement that it was announced by
  bool is_of_several = false;  ///< nothing of one parameter explains it; the change then has its time alone
  tracking::Change change{};
  std::vector<std::string> rivals{};  ///< what explains the parameter's course as well
};

/// What the recordings before and after an alarm's change say of terms that the model may lack.
struct AlarmDiagnosis {
  double announced = 0.0;  ///< of its alarm, as what follows
  bool is_of_several = false;
  Eigen::Index parameter = 0;
  double time = 0.0;     ///< of the change
  std::string answer{};  ///< an object of JSON: "says", and "term" where one is a rival

  bool isOf(const TrackAlarm& alarm) const {
    return announced == alarm.announced && is_of_several == alarm.is_of_several &&
           parameter == alarm.change.parameter && time == alarm.change.time;
  }
};

/// What belongs to the estimates of the last measurements: for rivals of a change.
struct CourseSample {
  double time = 0.0;
  Eigen::VectorXd estimate, variances;  ///< p, coordinates
  std::vector<Covariate> covariates;
};

/// All that follows from the measurements up to one of them. Constant in size.
struct TrackPoint {
  tracking::Tracker tracker;
  std::deque<CourseSample> course{};  ///< the last kCourseSamples
  std::vector<TrackAlarm> alarms{};   ///< the last kKeptAlarms
  long long alarm_count = 0;
  double uncalibrated_at = -1.0;  ///< measurement (number) at which rates were last widened; none: -1
};
constexpr std::size_t kCourseSamples = 80, kKeptAlarms = 20;

/// One measurement later.
tracking::Step advance(const TrackRecord& record, TrackPoint& point);

/// Which covariates explain the courses of parameters, all together, as well as a step of each at the time of
/// a change does. They are weighted least squares of a parabola over each, as good within log(20) of
/// likelihood.
std::vector<std::string> findRivals(const std::deque<CourseSample>& course,
                                    const std::vector<Eigen::Index>& parameters, double change);

/// Which rivals at least two alarms have that were announced since a time. What the model lacks moves other
/// parameters too, so that they are rivals of whatever changes next.
std::vector<std::string> findRecurringRivals(const std::vector<TrackAlarm>& alarms, double since);

/// Measurements in the order of their times, whatever order they come in. As many as `lag` back can be
/// inserted. The twin is computed again from there, so that the result has the same bits.
class TrackedTwin {
 public:
  TrackedTwin(tracking::Model model, int lag);
  /// Where a state file left off. window: in order.
  TrackedTwin(TrackPoint base, std::deque<TrackRecord> window, int lag,
              std::deque<AlarmDiagnosis> diagnoses = {});

  /// The same measurement that is within the window; null of none.
  const TrackRecord* findSame(const TrackRecord& record) const;
  /// Whether a record belongs before the window.
  bool isTooLate(const TrackRecord& record) const;
  bool isLate(const TrackRecord& record) const { return !window_.empty() && record.isBefore(window_.back()); }

  /// A new one that is not too late. Returns what became of the last measurement (in time).
  tracking::Step add(TrackRecord record);

  /// The last alarm, where it has no diagnosis yet; null of none.
  const TrackAlarm* findUndiagnosed() const;
  void note(AlarmDiagnosis diagnosis);

  const TrackPoint& getBase() const { return base_; }
  const TrackPoint& getNow() const { return now_; }
  const std::deque<TrackRecord>& getWindow() const { return window_; }
  /// Of the last kKeptAlarms that have one.
  const std::deque<AlarmDiagnosis>& getDiagnoses() const { return diagnoses_; }

 private:
  TrackPoint base_, now_;  // before the window, and behind it
  std::deque<TrackRecord> window_;
  std::size_t lag_;
  std::deque<AlarmDiagnosis> diagnoses_;  // not of a point: late measurements move alarms, and leave these
};

}  // namespace twinmap
