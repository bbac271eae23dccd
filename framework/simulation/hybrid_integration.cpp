#include "framework/simulation/hybrid_integration.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>

#include "framework/simulation/first_step.hpp"

namespace twinmap {
namespace {

namespace odeint = boost::numeric::odeint;
using State = OdeProblem::State;
using Dopri5 = odeint::runge_kutta_dopri5<State>;
using ControlledDopri5 = odeint::controlled_runge_kutta<Dopri5>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

class HybridIntegration {
 public:
  HybridIntegration(HybridProblem& problem, State x, const Eigen::VectorXd& output_times,
                    const IntegrationOptions& options, const StepSequence* given)
      : problem_(problem),
        given_(given),
        output_times_(output_times),
        options_(options),
        guard_(options),
        stepper_(
            ControlledDopri5::error_checker_type(options.absolute_tolerance, options.relative_tolerance)),
        x_(std::move(x)),
        dxdt_(x_.size()),
        x_new_(x_.size()),
        dxdt_new_(x_.size()),
        x_between_(x_.size()),
        indicators_(problem.getIndicatorCount()),
        indicators_new_(problem.getIndicatorCount()) {}

  HybridReport run(const std::vector<double>& boundaries) {
    for (std::size_t i = 0; i + 1 < boundaries.size() && isRunning(); ++i) {
      t_ = boundaries[i];
      problem_.enterPhase(t_, x_);
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
    constexpr int kMostAtOnce = 1000;  // events at one time that a model may chain
    events_here_ = t_ == last_event_ ? events_here_ + 1 : 0;
    last_event_ = t_;
    ++report_.steps;
    report_.failure = events_here_ > kMostAtOnce ? describeAt("events follow one another without end", t_)
                                                 : guard_.check(report_.steps, t_);
    if (report_.failure.empty()) {
      problem_.handleEvent(t_, x_);
    }
  }

  void restart() {
    problem_.calcDerivative(t_, x_, dxdt_);
    if (!isFinite(x_) || !isFinite(dxdt_)) {
      report_.failure = describeAt("state became non-finite", t_);
    }
    if (!indicators_.empty()) {
      problem_.calcIndicators(t_, x_, indicators_.data());
    }
    begin_ = t_;
    report_.sequence.emplace_back();
  }

  /// Until `stop`, or until an event, for which it returns true.
  bool runSteps(double stop) {
    if (given_ != nullptr) {
      return replaySteps(stop);
    }
    double dt = report_.failure.empty() ? calcFirstStep(problem_, t_, x_, dxdt_, stop - t_, options_) : 0.0;
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
    const auto f = [this](const State& x, State& dxdt, double t) { problem_.calcDerivative(t, x, dxdt); };
    ++report_.steps;
    stepper_.stepper().do_step(f, x_, dxdt_, t_, x_new_, dxdt_new_, t_new - t_);
    if (!isFinite(x_new_) || !isFinite(dxdt_new_)) {
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
      return dt;
    }
    const bool last = t_ + 1.01 * dt >= stop;
    const double planned = last ? stop - t_ : std::min(dt, 0.5 * (stop - t_));
    double t_new = t_;
    double proposed = planned;
    ++report_.steps;
    const auto f = [this](const State& x, State& dxdt, double t) { problem_.calcDerivative(t, x, dxdt); };
    const bool accepted =
        stepper_.try_step(f, x_, dxdt_, t_new, x_new_, dxdt_new_, proposed) == odeint::success;
    if (accepted && isFinite(x_new_) && isFinite(dxdt_new_)) {
      event = accept(last ? stop : t_new, stop);
      return std::max(proposed, planned);
    }
    ++report_.rejected;
    return shrink(accepted || !std::isfinite(proposed) ? 0.1 * planned : proposed);
  }

  double shrink(double dt) {
    if (dt <= 8.0 * kEpsilon * std::max(std::abs(t_), 1e-9)) {
      const bool finite = isFinite(x_new_) && isFinite(dxdt_new_);
      report_.failure = describeAt(finite ? "step size became too small" : "state became non-finite", t_);
    }
    return dt;
  }

  /// Goes to t_new or to the first event before it; true at an event.
  bool accept(double t_new, double stop) {
    double t_end = t_new;
    const bool crossed = !indicators_.empty() && findEvent(t_new, t_end);
    recordBefore(t_end, t_new);
    if (crossed && t_end < t_new) {
      interpolate(t_end, t_new);
      x_.swap(x_between_);
    } else {
      x_.swap(x_new_);
      dxdt_.swap(dxdt_new_);
    }
    t_ = t_end;
    indicators_.swap(indicators_new_);  // those at t_end
    report_.state_events += crossed ? 1 : 0;
    report_.sequence.back().push_back(t_ == stop ? 1.0 : (t_ - begin_) / (stop - begin_));
    return problem_.completeStep(t_, x_) || crossed;
  }

  const State& interpolate(double t, double t_new) {
    stepper_.stepper().calc_state(t, x_between_, x_, dxdt_, t_, x_new_, dxdt_new_, t_new);
    return x_between_;
  }

  void recordBefore(double t_end, double t_new) {
    for (; next_output_ < output_times_.size() && output_times_[next_output_] < t_end; ++next_output_) {
      const double t = output_times_[next_output_];
      problem_.recordOutput(static_cast<int>(next_output_), t, interpolate(t, t_new));
    }
  }

  /// Whether any indicator at t, on the step to t_new, is on another side than where the step began.
  bool isCrossed(double t, double t_new) {
    const State& x = t < t_new ? interpolate(t, t_new) : x_new_;
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
      problem_.recordOutput(static_cast<int>(next_output_), t_, x_);
    }
  }

  HybridProblem& problem_;
  const StepSequence* given_;
  const Eigen::VectorXd& output_times_;
  const IntegrationOptions& options_;
  IntegrationGuard guard_;
  ControlledDopri5 stepper_;
  HybridReport report_;
  double t_ = 0.0, begin_ = 0.0;  ///< s; begin_: of the steps since the last event
  State x_, dxdt_, x_new_, dxdt_new_, x_between_;
  std::vector<double> indicators_, indicators_new_;
  Eigen::Index next_output_ = 0;
  double last_event_ = -1.0;
  int events_here_ = 0;
};

}  // namespace

HybridReport integrateHybrid(HybridProblem& problem, OdeProblem::State x,
                             const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                             const IntegrationOptions& options, const StepSequence* given) {
  return HybridIntegration(problem, std::move(x), output_times, options, given).run(boundaries);
}

}  // namespace twinmap
