#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/fmi/sample_run.hpp"
#include "framework/simulation/hybrid_integration.hpp"

namespace twinmap::fmi {
namespace {

/// States are integrated in multiples of their nominal values, so that the absolute tolerance suits all of
/// them.
class ModelExchangeProblem final : public HybridProblem {
 public:
  explicit ModelExchangeProblem(SampleRun& run)
      : run_(run), fmu_(run.instance), nominals_(fmu_.getStateCount(), 1.0), states_(fmu_.getStateCount()) {}

  State makeState() const { return State(states_.size()); }

  std::size_t getIndicatorCount() const override { return fmu_.getIndicatorCount(); }
  double getNextEventTime() const override { return next_event_; }
  bool isOver() const override { return over_; }

  /// The first phase begins in event mode, where the initialisation left the FMU.
  void enterPhase(double begin, State& x) override {
    run_.excitation.beginPhase(begin);
    if (started_) {
      apply(begin, x);
      fmu_.enterEventMode();
      run_.inputs.setAll(fmu_, run_.excitation, begin);
    }
    started_ = true;
    iterate(begin, x);
  }

  void handleEvent(double t, State& x) override {
    apply(t, x);
    fmu_.enterEventMode();
    iterate(t, x);
  }

  void calcDerivative(double t, const State& x, State& dxdt) override {
    const auto finite = [](double value) { return std::isfinite(value); };
    bool known = std::all_of(x.begin(), x.end(), finite);
    if (known) {
      apply(t, x);
      known = dxdt.empty() || fmu_.getDerivatives(dxdt.data(), dxdt.size());
    }
    for (std::size_t i = 0; i < dxdt.size(); ++i) {
      dxdt[i] = known ? dxdt[i] / nominals_[i] : std::numeric_limits<double>::quiet_NaN();  // a smaller step
    }
  }

  void calcIndicators(double t, const State& x, double* indicators) override {
    apply(t, x);
    fmu_.getIndicators(indicators, fmu_.getIndicatorCount());
  }

  bool completeStep(double t, const State& x) override {
    apply(t, x);
    const IntegratorStepEnd end = fmu_.completeIntegratorStep();
    over_ = over_ || end.terminate;
    return end.enter_event_mode;
  }

  void recordOutput(int index, double t, const State& x) override {
    apply(t, x);
    run_.record(index);
  }

 private:
  void apply(double t, const State& x) {
    fmu_.setTime(t);
    for (std::size_t i = 0; i < x.size(); ++i) {
      states_[i] = x[i] * nominals_[i];
    }
    if (!x.empty()) {
      fmu_.setStates(states_.data(), states_.size());
    }
    run_.inputs.setContinuous(fmu_, run_.excitation, t);
  }

  /// Event iteration, then back to continuous time with the states that it left.
  void iterate(double t, State& x) {
    const EventInfo info = iterateEvents(fmu_, t);
    over_ = over_ || info.terminate;
    next_event_ = info.next_time.value_or(std::numeric_limits<double>::infinity());
    fmu_.enterContinuousTimeMode();
    readStates(x);
  }

  void readStates(State& x) {
    if (x.empty()) {
      return;
    }
    fmu_.getNominals(nominals_.data(), nominals_.size());
    fmu_.getStates(states_.data(), states_.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(nominals_[i] > 0.0 && std::isfinite(nominals_[i]))) {
        nominals_[i] = 1.0;  // an FMU that knows none
      }
      x[i] = states_[i] / nominals_[i];
    }
  }

  SampleRun& run_;
  Instance& fmu_;
  std::vector<double> nominals_, states_;
  double next_event_ = std::numeric_limits<double>::infinity();
  bool started_ = false, over_ = false;
};

}  // namespace

void runModelExchange(SampleRun& run) {
  run.initialise();
  run.excitation.mute();  // its first phase begins again
  ModelExchangeProblem problem(run);
  std::vector<double> boundaries = run.excitation.calcEventTimes(run.setting.duration);
  boundaries.insert(boundaries.begin(), 0.0);
  boundaries.push_back(run.setting.duration);
  HybridReport report =
      integrateHybrid(problem, problem.makeState(), boundaries, run.setting.times, run.setting.integration,
                      run.sequence.empty() ? nullptr : &run.sequence);
  if (!report.failure.empty()) {
    throw FmuFailure(report.failure);
  }
  if (run.sequence.empty() && report.state_events == 0) {
    run.sequence = std::move(report.sequence);
  }
}

}  // namespace twinmap::fmi
