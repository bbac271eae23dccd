#include <algorithm>
#include <cmath>

#include "framework/fmi/communication_points.hpp"
#include "framework/fmi/sample_run.hpp"

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
    recordAt(0.0);
    for (std::size_t i = 1; i < grid_.points.size(); ++i) {
      step(grid_.points[i - 1], grid_.points[i]);
      recordAt(grid_.points[i]);
    }
  }

 private:
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
    for (; next_event_ < events_.size() && events_[next_event_] <= t + resolution_; ++next_event_) {
      run_.excitation.beginPhase(events_[next_event_]);
    }
    const Eigen::VectorXd& times = run_.setting.times;
    if (next_output_ < times.size() && times[next_output_] <= t + resolution_) {
      if (!run_.inputs.isEmpty() && t > 0.0) {
        run_.inputs.setAll(run_.instance, run_.excitation, t);  // what outputs feed through
      }
      run_.record(static_cast<int>(next_output_++));
    }
  }

  /// Inputs are held over a step. Continuous ones at their value in its middle: the same integral, to second
  /// order.
  void setInputs(double begin, double end) {
    if (!run_.inputs.isEmpty()) {
      run_.inputs.setAll(run_.instance, run_.excitation, begin);
      run_.inputs.setContinuous(run_.instance, run_.excitation, 0.5 * (begin + end));
    }
  }

  void step(double begin, double end) {
    setInputs(begin, end);
    double t = begin;
    while (t < end - resolution_) {
      if (const std::string failure = guard_.check(steps_++, t); !failure.empty()) {
        throw FmuFailure(failure);
      }
      const double size = grid_.step > 0.0 && t == begin ? grid_.step : end - t;
      const CommunicationStepEnd reached = run_.instance.doStep(t, size);
      check(reached, t, end);
      t = reached.time;
    }
  }

  void check(const CommunicationStepEnd& reached, double t, double end) const {
    if (reached.terminate && reached.time < end - resolution_) {
      throw FmuFailure(describeAt("the FMU ended its simulation", reached.time));
    }
    if (reached.discarded && !reached.terminate) {
      throw StepDiscarded(describeAt("the FMU discards communication steps", t));
    }
    if (!(reached.time > t)) {
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
  int steps_ = 0;
};

}  // namespace

void runCoSimulation(SampleRun& run, double largest_step) {
  CoSimulation(run, largest_step).run();
}

}  // namespace twinmap::fmi
