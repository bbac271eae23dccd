#include <algorithm>
#include <limits>

#include "framework/models/fmu/run/communication_points.hpp"
#include "framework/models/fmu/run/sample_run.hpp"

namespace twinmap::fmi {
namespace {

class CoSimulation {
 public:
  CoSimulation(SampleRun& run, double largest_step)
      : run_(run),
        guard_(run.setting.integration),
        events_(run.excitation.calcEventTimes(run.setting.duration)),
        grid_(calcCommunicationGrid(collectTargets(), largest_step, run.capabilities)),
        resolution_(kResolution * std::max(grid_.points.back(), 1e-9)) {}

  void run() {
    run_.initialise();
    if (run_.instance.hasEventMode()) {
      iterate(0.0);
    }
    recordAt(0.0);
    for (std::size_t i = 1; i < grid_.points.size(); ++i) {
      step(grid_.points[i - 1], grid_.points[i]);
      recordAt(grid_.points[i]);
    }
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr double kResolution = 1e-10;  ///< share of the last time: one point, up to rounding

  /// What must be communication points: sample times, and edges of the excitation before the last of them.
  std::vector<double> collectTargets() const {
    const Eigen::VectorXd& times = run_.setting.times;
    std::vector<double> targets(times.data(), times.data() + times.size());
    const double last = targets.empty() ? 0.0 : targets.back();
    std::copy_if(events_.begin(), events_.end(), std::back_inserter(targets),
                 [last](double t) { return t < last; });
    std::sort(targets.begin(), targets.end());
    const auto same = [last](double a, double b) { return b - a <= kResolution * last; };
    targets.erase(std::unique(targets.begin(), targets.end(), same), targets.end());
    targets.erase(targets.begin(), std::upper_bound(targets.begin(), targets.end(), kResolution * last));
    return targets;
  }

  /// The phase of the excitation that begins at t, if one does, and the outputs there, if they are asked for.
  void recordAt(double t) {
    const bool edge = beginPhases(t);
    const bool by_events = run_.instance.hasEventMode() && !run_.inputs.isEmpty() && t > 0.0 && !over_;
    if (by_events && (edge || run_.inputs.hasDiscreteChanged(run_.excitation, t))) {
      run_.instance.enterEventMode();
      run_.inputs.setAll(run_.instance, run_.excitation, t);
      iterate(t);
    }
    const Eigen::VectorXd& times = run_.setting.times;
    if (next_output_ < times.size() && times[next_output_] <= t + resolution_) {
      if (t > 0.0) {
        setInputs(t, t);  // what outputs feed through
      }
      run_.record(static_cast<int>(next_output_++));
    }
  }

  /// Whether any begins.
  bool beginPhases(double t) {
    const std::size_t before = next_event_;
    for (; next_event_ < events_.size() && events_[next_event_] <= t + resolution_; ++next_event_) {
      run_.excitation.beginPhase(events_[next_event_]);
    }
    return next_event_ > before;
  }

  /// From event mode back to stepping.
  void iterate(double t) {
    const EventInfo info = iterateEvents(run_.instance, t);
    over_ = over_ || info.terminate;
    time_event_ = info.next_time && *info.next_time > t + resolution_ ? *info.next_time : kNever;
    if (!over_) {
      run_.instance.enterStepMode();
    }
  }

  /// Inputs are held over a step. Continuous ones at their value in its middle: the same integral, to second
  /// order.
  void setInputs(double begin, double end) {
    if (!run_.instance.hasEventMode()) {
      run_.inputs.setDiscrete(run_.instance, run_.excitation, begin);
    }
    run_.inputs.setContinuous(run_.instance, run_.excitation, 0.5 * (begin + end));
  }

  void step(double begin, double end) {
    setInputs(begin, end);
    double t = begin;
    while (t < end - resolution_) {
      if (const std::string failure = guard_.check(steps_++, t); !failure.empty()) {
        throw FmuFailure(failure);
      }
      if (over_) {
        throw FmuFailure(describeAt("the FMU ended its simulation", t));
      }
      const double size = grid_.step > 0.0 && t == begin ? grid_.step : std::min(end, chooseStop(t)) - t;
      const CommunicationStepEnd reached = run_.instance.doStep(t, size);
      check(reached, t);
      t = reached.time;
      if (!over_ && (reached.event || t >= time_event_ - resolution_)) {
        run_.instance.enterEventMode();
        iterate(t);
      }
    }
  }

  /// A time event that the FMU has announced, which a step may end at if the FMU's own steps do not miss it.
  double chooseStop(double t) const {
    const bool free = run_.capabilities.variable_step && !run_.capabilities.internal_step;
    return free && time_event_ > t + resolution_ ? time_event_ : kNever;
  }

  void check(const CommunicationStepEnd& reached, double t) {
    constexpr int kMaxAtOnce = 1000;  // events at one time that a model may chain
    over_ = over_ || reached.terminate;
    if (reached.discarded && !reached.terminate) {
      throw StepDiscarded(describeAt("the FMU discards communication steps", t));
    }
    if (over_) {
      return;
    }
    at_once_ = reached.time > t ? 0 : at_once_ + 1;
    if (at_once_ > (reached.event ? kMaxAtOnce : 0)) {
      throw FmuFailure(describeAt("a communication step made no progress", t));
    }
  }

  SampleRun& run_;
  IntegrationGuard guard_;
  std::vector<double> events_;
  CommunicationGrid grid_;
  double resolution_;  ///< s
  std::size_t next_event_ = 0;
  Eigen::Index next_output_ = 0;
  int steps_ = 0, at_once_ = 0;  ///< at_once_: steps that came no further
  double time_event_ = kNever;   ///< s
  bool over_ = false;            ///< the FMU has ended its simulation
};

}  // namespace

void runCoSimulation(SampleRun& run, double largest_step) {
  CoSimulation(run, largest_step).run();
}

}  // namespace twinmap::fmi
