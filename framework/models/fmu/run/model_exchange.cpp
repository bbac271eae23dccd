#include <algorithm>
#include <cmath>

#include "framework/models/fmu/run/model_exchange_problem.hpp"

namespace twinmap::fmi {

ModelExchangeProblem::ModelExchangeProblem(SampleRun& run)
    : run_(run), fmu_(run.instance), nominals_(fmu_.getStateCount(), 1.0), states_(fmu_.getStateCount()) {}

void ModelExchangeProblem::enterPhase(double begin, State& x) {
  run_.excitation.beginPhase(begin);
  if (started_) {
    apply(begin, x);
    fmu_.enterEventMode();
    run_.inputs.setAll(fmu_, run_.excitation, begin);
  }
  iterate(begin, x);
  started_ = true;
}

void ModelExchangeProblem::handleEvent(double t, State& x) {
  apply(t, x);
  fmu_.enterEventMode();
  iterate(t, x);
}

void ModelExchangeProblem::calcDerivative(double t, const State& x, State& dxdt) {
  const auto finite = [](double value) { return std::isfinite(value); };
  const std::size_t count = states_.size();
  bool known = std::all_of(x.begin(), x.end(), finite);
  if (known) {
    apply(t, x);
    known = count == 0 || fmu_.getDerivatives(dxdt.data(), count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    dxdt[i] = known ? dxdt[i] / nominals_[i] : std::numeric_limits<double>::quiet_NaN();  // a smaller step
  }
}

void ModelExchangeProblem::calcIndicators(double t, const State& x, double* indicators) {
  apply(t, x);
  fmu_.getIndicators(indicators, fmu_.getIndicatorCount());
}

bool ModelExchangeProblem::completeStep(double t, const State& x) {
  apply(t, x);
  const IntegratorStepEnd end = fmu_.completeIntegratorStep();
  over_ = over_ || end.terminate;
  return end.enter_event_mode;
}

void ModelExchangeProblem::recordOutput(int index, double t, const State& x) {
  apply(t, x);
  run_.record(index);
}

void ModelExchangeProblem::apply(double t, const State& x) {
  fmu_.setTime(t);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i] = x[i] * nominals_[i];
  }
  if (!states_.empty()) {
    fmu_.setStates(states_.data(), states_.size());
  }
  run_.inputs.setContinuous(fmu_, run_.excitation, t);
}

void ModelExchangeProblem::iterate(double t, State& x) {
  const EventInfo info = iterateEvents(fmu_, t);
  over_ = over_ || info.terminate;
  states_jumped_ = states_jumped_ || (started_ && info.states_changed);
  next_event_ = info.next_time.value_or(std::numeric_limits<double>::infinity());
  fmu_.enterContinuousTimeMode();
  readStates(x);
}

void ModelExchangeProblem::readStates(State& x) {
  if (states_.empty()) {
    return;
  }
  fmu_.getNominals(nominals_.data(), nominals_.size());
  fmu_.getStates(states_.data(), states_.size());
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!(nominals_[i] > 0.0 && std::isfinite(nominals_[i]))) {
      nominals_[i] = 1.0;  // an FMU that knows none
    }
    x[i] = states_[i] / nominals_[i];
  }
}

std::vector<double> collectBoundaries(const SampleRun& run) {
  std::vector<double> boundaries = run.excitation.calcEventTimes(run.setting.duration);
  boundaries.insert(boundaries.begin(), 0.0);
  boundaries.push_back(run.setting.duration);
  return boundaries;
}

void runModelExchange(SampleRun& run) {
  run.initialise();
  run.excitation.mute();  // its first phase begins again
  ModelExchangeProblem problem(run);
  HybridReport report = integrateHybrid(problem, problem.makeState(), collectBoundaries(run),
                                        run.setting.times, run.setting.integration,
                                        run.path.steps.empty() ? nullptr : &run.path.steps, run.path.method);
  if (report.reached_step_limit && run.path.method == HybridMethod::kExplicit) {
    throw StepLimitReached(report.failure);
  }
  if (!report.failure.empty()) {
    throw FmuFailure(report.failure);
  }
  if (run.path.steps.empty() && report.state_events == 0) {
    run.path.steps = std::move(report.sequence);
  }
}

}  // namespace twinmap::fmi
