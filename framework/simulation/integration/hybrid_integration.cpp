#include "framework/simulation/integration/hybrid_integration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/simulation/integration/first_step.hpp"

namespace twinmap {
namespace {

using State = OdeProblem::State;
using Point = HybridStepper::Point;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

class HybridIntegration {
 public:
  HybridIntegration(HybridProblem& problem, State x, const Eigen::VectorXd& output_times,
                    const IntegrationOptions& options, const StepSequence* given, HybridMethod method)
      : problem_(problem),
        given_(given),
        output_times_(output_times),
        options_(options),
        guard_(options),
        stepper_(makeHybridStepper(method, options)),
        now_{0.0, std::move(x), {}},
        x_between_(now_.x.size()),
        indicators_(problem.getIndicatorCount()),
        indicators_new_(problem.getIndicatorCount()) {
    now_.dxdt.resize(now_.x.size());
    new_ = now_;
  }

  HybridReport run(const std::vector<double>& boundaries) {
    for (std::size_t i = 0; i + 1 < boundaries.size() && isRunning(); ++i) {
      t_ = boundaries[i];
      problem_.enterPhase(t_, now_.x);
      runPhase(boundaries[i + 1]);
    }
    finish(boundaries.back());
    return report_;
  }

 private:
  bool isRunning() const { return report_.failure.empty() && !problem_.isOver(); }

  /// From event to event.
  void runPhase(double end) {
    while (t_ < end && isRunning()) {
      const double next = problem_.getNextEventTime();
      if (next <= t_ + kEpsilon * std::abs(t_)) {
        handleEvent();
        continue;
      }
      const double stop = std::min(end, next);
      restart();
      const bool event = runSteps(stop);
      if (report_.failure.empty() && (event || (t_ == next && t_ < end))) {
        handleEvent();
      }
    }
  }

  void handleEvent() {
    constexpr int kMaxAtOnce = 1000;  // events at one time that a model may chain
    events_here_ = t_ == last_event_ ? events_here_ + 1 : 0;
    last_event_ = t_;
    ++report_.steps;
    report_.failure = events_here_ > kMaxAtOnce ? describeAt("events follow one another without end", t_)
                                                : guard_.check(report_.steps, t_);
    if (report_.failure.empty()) {
      problem_.handleEvent(t_, now_.x);
    }
  }

  void restart() {
    problem_.calcDerivative(t_, now_.x, now_.dxdt);
    if (!isFinite(now_.x) || !isFinite(now_.dxdt)) {
      report_.failure = describeAt("state became non-finite", t_);
    }
    if (!indicators_.empty()) {
      problem_.calcIndicators(t_, now_.x, indicators_.data());
    }
    begin_ = t_;
    report_.sequence.emplace_back();
  }

  /// Until `stop`, or until an event, for which it returns true.
  bool runSteps(double stop) {
    if (given_ != nullptr) {
      return replaySteps(stop);
    }
    double dt =
        report_.failure.empty() ? calcFirstStep(problem_, t_, now_.x, now_.dxdt, stop - t_, options_) : 0.0;
    bool event = false;
    while (t_ < stop && !event && report_.failure.empty()) {
      dt = step(dt, stop, event);
    }
    return event;
  }

  /// As runSteps(); a state event is a failure.
  bool replaySteps(double stop) {
    bool event = false;
    if (report_.sequence.size() > given_->size()) {
      report_.failure = describeAt("events are not those of the centre", t_);
    }
    for (std::size_t i = 0; report_.failure.empty() && i < (*given_)[report_.sequence.size() - 1].size();
         ++i) {
      const double fraction = (*given_)[report_.sequence.size() - 1][i];
      event = replayStep(fraction == 1.0 ? stop : begin_ + fraction * (stop - begin_), stop);
    }
    return event;
  }

  bool replayStep(double t_new, double stop) {
    ++report_.steps;
    stepper_->doStep(problem_, now_, t_new, new_);
    if (!isFinite(new_.x) || !isFinite(new_.dxdt)) {
      report_.failure = describeAt("state became non-finite", t_);
      return false;
    }
    const bool event = accept(t_new, stop);
    if (event && t_ < stop) {
      report_.failure = describeAt("events are not those of the centre", t_);
    }
    return event;
  }

  /// Tries one step of size dt at most; returns the size to try next.
  double step(double dt, double stop, bool& event) {
    report_.failure = guard_.check(report_.steps, t_);
    if (!report_.failure.empty()) {
      report_.reached_step_limit = true;
      return dt;
    }
    const double target = chooseTarget(stop);
    const bool last = t_ + 1.01 * dt >= target;
    const double planned = last ? target - t_ : std::min(dt, 0.5 * (target - t_));
    double proposed = planned;
    ++report_.steps;
    const bool accepted = stepper_->tryStep(problem_, now_, new_, proposed);
    if (accepted && isFinite(new_.x) && isFinite(new_.dxdt)) {
      event = accept(last ? target : new_.t, stop);
      return std::max(proposed, planned);
    }
    ++report_.rejected;
    return shrink(accepted || !std::isfinite(proposed) ? 0.1 * planned : proposed);
  }

  double chooseTarget(double stop) const {
    const bool past = next_output_ < output_times_.size() && output_times_[next_output_] <= t_;
    const Eigen::Index next = next_output_ + (past ? 1 : 0);  // that of now is recorded with the next step
    const bool ends = !stepper_->interpolatesAccurately() && next < output_times_.size();
    return ends ? std::min(stop, output_times_[next]) : stop;
  }

  double shrink(double dt) {
    if (dt <= 8.0 * kEpsilon * std::max(std::abs(t_), 1e-9)) {
      const bool finite = isFinite(new_.x) && isFinite(new_.dxdt);
      report_.failure = describeAt(finite ? "step size became too small" : "state became non-finite", t_);
    }
    return dt;
  }

  /// Goes to t_new or to the first event before it; true at an event.
  bool accept(double t_new, double stop) {
    double t_end = t_new;
    new_.t = t_new;
    const bool crossed = !indicators_.empty() && findEvent(t_new, t_end);
    recordBefore(t_end);
    if (crossed && t_end < t_new) {
      interpolate(t_end);
      now_.x.swap(x_between_);
    } else {
      now_.x.swap(new_.x);
      now_.dxdt.swap(new_.dxdt);
    }
    t_ = t_end;
    indicators_.swap(indicators_new_);  // those at t_end
    report_.state_events += crossed ? 1 : 0;
    report_.sequence.back().push_back(t_ == stop ? 1.0 : (t_ - begin_) / (stop - begin_));
    return problem_.completeStep(t_, now_.x) || crossed;
  }

  const State& interpolate(double t) {
    stepper_->interpolate(t, now_, new_, x_between_);
    return x_between_;
  }

  void recordBefore(double t_end) {
    for (; next_output_ < output_times_.size() && output_times_[next_output_] < t_end; ++next_output_) {
      const double t = output_times_[next_output_];
      problem_.recordOutput(static_cast<int>(next_output_), t, interpolate(t));
    }
  }

  /// Whether any indicator at t, on the step to t_new, is on another side than where the step began.
  bool isCrossed(double t, double t_new) {
    const State& x = t < t_new ? interpolate(t) : new_.x;
    problem_.calcIndicators(t, x, indicators_new_.data());
    for (std::size_t i = 0; i < indicators_.size(); ++i) {
      if ((indicators_[i] > 0.0) != (indicators_new_[i] > 0.0)) {
        return true;
      }
    }
    return false;
  }

  /// The first of some points of the step beyond an event becomes t_event, by bisection the earliest time
  /// that a double tells from the event.
  bool findEvent(double t_new, double& t_event) {
    constexpr int kPoints = 4;  // what crosses back between two of them is not seen
    double before = t_;
    for (int i = 1; i <= kPoints; ++i) {
      const double t = i == kPoints ? t_new : t_ + (t_new - t_) * i / kPoints;
      if (isCrossed(t, t_new)) {
        t_event = bisect(before, t, t_new);
        return true;
      }
      before = t;
    }
    return false;
  }

  double bisect(double before, double after, double t_new) {
    const double resolution = 4.0 * kEpsilon * std::max(std::abs(t_), t_new - t_);
    while (after - before > resolution) {
      const double middle = 0.5 * (before + after);
      (isCrossed(middle, t_new) ? after : before) = middle;
    }
    isCrossed(after, t_new);  // the indicators there
    return after;
  }

  /// What is due at the end, and the outputs there.
  void finish(double end) {
    if (isRunning() && problem_.getNextEventTime() <= end) {
      handleEvent();
    }
    const bool complete = output_times_.size() == 0 || output_times_[output_times_.size() - 1] <= t_;
    if (report_.failure.empty() && problem_.isOver() && !complete) {
      report_.failure = describeAt("the model ended its simulation", t_);
    }
    for (; report_.failure.empty() && next_output_ < output_times_.size(); ++next_output_) {
      problem_.recordOutput(static_cast<int>(next_output_), t_, now_.x);
    }
  }

  HybridProblem& problem_;
  const StepSequence* given_;
  const Eigen::VectorXd& output_times_;
  const IntegrationOptions& options_;
  IntegrationGuard guard_;
  std::unique_ptr<HybridStepper> stepper_;
  HybridReport report_;
  double begin_ = 0.0;  ///< s, of the steps since the last event
  Point now_, new_;     ///< new_: the end of a step that is tried
  double& t_ = now_.t;
  State x_between_;
  std::vector<double> indicators_, indicators_new_;
  Eigen::Index next_output_ = 0;
  double last_event_ = -1.0;
  int events_here_ = 0;
};

}  // namespace

HybridReport integrateHybrid(HybridProblem& problem, OdeProblem::State x,
                             const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                             const IntegrationOptions& options, const StepSequence* given,
                             HybridMethod method) {
  return HybridIntegration(problem, std::move(x), output_times, options, given, method).run(boundaries);
}

}  // namespace twinmap
