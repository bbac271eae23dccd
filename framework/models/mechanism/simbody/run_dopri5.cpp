#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/models/mechanism/simbody/run_sample.hpp"

namespace twinmap {
namespace {

/// x = [q; u; z] in Simbody's order.
class MultibodyOde : public OdeProblem {
 public:
  MultibodyOde(const SampleRun& run, SimTK::State& state)
      : run_(run), tree_(run.system.getTree()), state_(state) {
    run_.excitation.mute();
  }

  void beginPhase(double begin) override { run_.excitation.beginPhase(begin); }

  void calcDerivative(double t, const State& x, State& dxdt) override {
    if (!std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); })) {
      std::fill(dxdt.begin(), dxdt.end(), std::numeric_limits<double>::quiet_NaN());
      return;  // nothing that Simbody should see; the step is rejected
    }
    setState(x);
    tree_.realizeVelocity(state_);
    const Eigen::VectorXd& udot = run_.system.calcUDot(state_, t);
    const SimTK::Vector& qdot = tree_.getMatter().getQDot(state_);
    std::copy_n(qdot.getContiguousScalarData(), qdot.size(), dxdt.begin());
    std::copy_n(udot.data(), udot.size(), dxdt.begin() + qdot.size());
    const std::vector<double>& rates = run_.system.getStateRates();
    std::copy(rates.begin(), rates.end(), dxdt.begin() + qdot.size() + udot.size());
  }

  void recordOutput(int index, double t, const State& x) override {
    setState(x);
    tree_.getSystem().realize(state_, run_.outputs.getNeededStage());
    run_.record(index, t, state_);
  }

 private:
  void setState(const State& x) {
    SimTK::Vector& q = state_.updQ();
    std::copy_n(x.begin(), q.size(), q.updContiguousScalarData());
    SimTK::Vector& u = state_.updU();
    std::copy_n(x.begin() + q.size(), u.size(), u.updContiguousScalarData());
    if (const int states = run_.system.countStates(); states > 0) {
      std::copy_n(x.end() - states, states, state_.updZ().updContiguousScalarData());
    }
  }

  const SampleRun& run_;
  const BodyTree& tree_;
  SimTK::State& state_;
};

OdeProblem::State getValues(const SimTK::State& state) {
  OdeProblem::State x;
  for (int i = 0; i < state.getNQ(); ++i) {
    x.push_back(state.getQ()[i]);
  }
  for (int i = 0; i < state.getNU(); ++i) {
    x.push_back(state.getU()[i]);
  }
  for (int i = 0; i < state.getNZ(); ++i) {
    x.push_back(state.getZ()[i]);
  }
  return x;
}

}  // namespace

std::vector<double> SampleRun::calcBoundaries() const {
  std::vector<double> boundaries = excitation.calcEventTimes(simulation.duration);
  boundaries.insert(boundaries.begin(), 0.0);
  boundaries.push_back(simulation.duration);
  return boundaries;
}

std::string runDopri5(const SampleRun& run, StepSequence& sequence) {
  SimTK::State state = run.system.getTree().getDefaultState();
  setState(run.system, run.initial, state);
  MultibodyOde ode(run, state);
  const IntegrationOptions options{run.simulation.relative_tolerance, run.simulation.absolute_tolerance,
                                   run.simulation.max_steps, run.simulation.max_wall_time};
  if (!sequence.empty()) {
    return replayDopri5(ode, getValues(state), run.calcBoundaries(), run.times, sequence).failure;
  }
  IntegrationReport report = integrateDopri5(ode, getValues(state), run.calcBoundaries(), run.times, options);
  if (report.failure.empty()) {
    sequence = std::move(report.sequence);
  }
  return report.failure;
}

}  // namespace twinmap
