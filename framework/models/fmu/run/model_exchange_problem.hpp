#pragma once

#include <limits>

#include "framework/models/fmu/run/sample_run.hpp"
#include "framework/simulation/integration/hybrid_integration.hpp"

namespace twinmap::fmi {

/// The equations of a Model Exchange FMU. States are integrated in multiples of their nominal values, so that
/// the absolute tolerance suits all of them.
class ModelExchangeProblem : public HybridProblem {
 public:
  explicit ModelExchangeProblem(SampleRun& run);

  virtual State makeState() const { return State(states_.size()); }

  std::size_t getIndicatorCount() const override { return fmu_.getIndicatorCount(); }
  double getNextEventTime() const override { return next_event_; }
  bool isOver() const override { return over_; }

  /// The first phase begins in event mode, where the initialisation left the FMU.
  void enterPhase(double begin, State& x) override;
  void handleEvent(double t, State& x) override;
  void calcDerivative(double t, const State& x, State& dxdt) override;
  void calcIndicators(double t, const State& x, double* indicators) override;
  bool completeStep(double t, const State& x) override;
  void recordOutput(int index, double t, const State& x) override;

 protected:
  SampleRun& run_;
  Instance& fmu_;
  bool states_jumped_ = false;  ///< at any event but the first

 private:
  void apply(double t, const State& x);
  /// Event iteration, then back to continuous time with the states that it left.
  void iterate(double t, State& x);
  void readStates(State& x);

  std::vector<double> nominals_, states_;
  double next_event_ = std::numeric_limits<double>::infinity();
  bool started_ = false, over_ = false;
};

/// Times at which the integration of a sample restarts: its begin and end, and edges of the excitation.
std::vector<double> collectBoundaries(const SampleRun& run);

}  // namespace twinmap::fmi
