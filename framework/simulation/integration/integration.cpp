#include "framework/simulation/integration/integration.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>

#include "framework/simulation/integration/first_step.hpp"

namespace twinmap {
namespace {

namespace odeint = boost::numeric::odeint;
using State = OdeProblem::State;
using Dopri5 = odeint::runge_kutta_dopri5<State>;
using ControlledDopri5 = odeint::controlled_runge_kutta<Dopri5>;

class Integration {
 public:
  Integration(OdeProblem& problem, State x, const Eigen::VectorXd& output_times,
              const IntegrationOptions& options)
      : problem_(problem),
        output_times_(output_times),
        options_(options),
        guard_(options),
        stepper_(
            ControlledDopri5::error_checker_type(options.absolute_tolerance, options.relative_tolerance)),
        x_(std::move(x)),
        dxdt_(x_.size()),
        x_new_(x_.size()),
        dxdt_new_(x_.size()),
        x_out_(x_.size()) {}

  /// With the steps of `given`, or with error control where that is null.
  IntegrationReport run(const std::vector<double>& boundaries, const StepSequence* given) {
    for (std::size_t i = 0; i + 1 < boundaries.size() && report_.failure.empty(); ++i) {
      runPhase(boundaries[i], boundaries[i + 1], given == nullptr ? nullptr : &(*given)[i]);
    }
    if (report_.failure.empty()) {
      recordRemaining(boundaries.back());
    }
    return report_;
  }

 private:
  void calcDerivative(const State& x, State& dxdt, double t) { problem_.calcDerivative(t, x, dxdt); }

  void runPhase(double begin, double end, const std::vector<double>* given) {
    problem_.beginPhase(begin);
    calcDerivative(x_, dxdt_, begin);
    if (!isFinite(x_) || !isFinite(dxdt_)) {
      report_.failure = describeAt("state became non-finite", begin);
      return;
    }
    t_ = begin;
    report_.sequence.emplace_back();
    if (given != nullptr) {
      replaySteps(begin, end, *given);
    } else {
      controlSteps(begin, end);
    }
  }

  void controlSteps(double begin, double end) {
    double dt = calcFirstStep(problem_, begin, x_, dxdt_, end - begin, options_);
    while (t_ < end && report_.failure.empty()) {
      const double t_before = t_;
      dt = step(dt, end);
      if (t_ > t_before) {
        report_.sequence.back().push_back(t_ == end ? 1.0 : (t_ - begin) / (end - begin));
      }
    }
  }

  void replaySteps(double begin, double end, const std::vector<double>& fractions) {
    const auto f = [this](const State& x, State& dxdt, double t) { calcDerivative(x, dxdt, t); };
    report_.sequence.back() = fractions;
    for (const double fraction : fractions) {
      const double t_new = fraction == 1.0 ? end : begin + fraction * (end - begin);
      ++report_.steps;
      stepper_.stepper().do_step(f, x_, dxdt_, t_, x_new_, dxdt_new_, t_new - t_);
      if (!isFinite(x_new_) || !isFinite(dxdt_new_)) {
        report_.failure = describeAt("state became non-finite", t_);
        return;
      }
      accept(t_new);
    }
  }

  /// Tries one step of size dt at most; returns the size to try next.
  double step(double dt, double end) {
    report_.failure = guard_.check(report_.steps, t_);
    if (!report_.failure.empty()) {
      return dt;
    }
    const bool last = t_ + 1.01 * dt >= end;
    const double planned = last ? end - t_ : std::min(dt, 0.5 * (end - t_));
    double t_new = t_;
    double proposed = planned;
    ++report_.steps;
    const auto f = [this](const State& x, State& dxdt, double t) { calcDerivative(x, dxdt, t); };
    const bool accepted =
        stepper_.try_step(f, x_, dxdt_, t_new, x_new_, dxdt_new_, proposed) == odeint::success;
    if (accepted && isFinite(x_new_) && isFinite(dxdt_new_)) {
      accept(last ? end : t_new);
      return std::max(proposed, planned);
    }
    ++report_.rejected;
    return shrink(accepted || !std::isfinite(proposed) ? 0.1 * planned : proposed);
  }

  double shrink(double dt) {
    if (dt <= 8.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t_), 1e-9)) {
      const bool finite = isFinite(x_new_) && isFinite(dxdt_new_);
      report_.failure = describeAt(finite ? "step size became too small" : "state became non-finite", t_);
    }
    return dt;
  }

  void accept(double t_new) {
    for (; next_output_ < output_times_.size() && output_times_[next_output_] < t_new; ++next_output_) {
      const double t = output_times_[next_output_];
      stepper_.stepper().calc_state(t, x_out_, x_, dxdt_, t_, x_new_, dxdt_new_, t_new);
      problem_.recordOutput(static_cast<int>(next_output_), t, x_out_);
    }
    x_.swap(x_new_);
    dxdt_.swap(dxdt_new_);
    t_ = t_new;
  }

  void recordRemaining(double end) {
    for (; next_output_ < output_times_.size(); ++next_output_) {
      problem_.recordOutput(static_cast<int>(next_output_), end, x_);
    }
  }

  OdeProblem& problem_;
  const Eigen::VectorXd& output_times_;
  const IntegrationOptions& options_;
  IntegrationGuard guard_;
  ControlledDopri5 stepper_;
  IntegrationReport report_;
  double t_ = 0.0;
  State x_, dxdt_, x_new_, dxdt_new_, x_out_;
  Eigen::Index next_output_ = 0;
};

}  // namespace

IntegrationReport integrateDopri5(OdeProblem& problem, OdeProblem::State x,
                                  const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                                  const IntegrationOptions& options) {
  return Integration(problem, std::move(x), output_times, options).run(boundaries, nullptr);
}

IntegrationReport replayDopri5(OdeProblem& problem, OdeProblem::State x,
                               const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                               const StepSequence& sequence) {
  if (sequence.size() + 1 != boundaries.size()) {
    IntegrationReport report;
    report.failure = "the phases of the excitation are not those of the centre";
    return report;
  }
  const IntegrationOptions unused;
  return Integration(problem, std::move(x), output_times, unused).run(boundaries, &sequence);
}

}  // namespace twinmap
