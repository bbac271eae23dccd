#include "framework/models/mechanism/simbody/run_sample.hpp"

namespace twinmap {
namespace {

class SimbodyRun {
 public:
  explicit SimbodyRun(const SampleRun& run)
      : run_(run),
        options_{run.simulation.relative_tolerance, run.simulation.absolute_tolerance,
                 run.simulation.max_steps, run.simulation.max_wall_time},
        guard_(options_),
        state_(run.system.getTree().getDefaultState()) {
    setState(run.system, run.initial, state_);
    run_.excitation.mute();
  }

  std::string run() {
    const std::vector<double> boundaries = run_.calcBoundaries();
    for (std::size_t i = 0; i + 1 < boundaries.size() && failure_.empty(); ++i) {
      runPhase(boundaries[i], boundaries[i + 1]);
    }
    while (failure_.empty() && next_ < run_.times.size()) {
      record(state_);
    }
    return failure_;
  }

 private:
  void runPhase(double begin, double end) {
    run_.excitation.beginPhase(begin);
    SimTK::RungeKuttaMersonIntegrator integrator(run_.system.getTree().getSystem());
    integrator.setAccuracy(run_.simulation.relative_tolerance);
    if (run_.system.getTree().hasConstraints()) {
      constexpr double kOfLength = 1e-10;  // loops stay closed to 1e-9
      integrator.setConstraintTolerance(kOfLength);
    }
    integrator.setFinalTime(end);
    integrator.setReturnEveryInternalStep(true);  // so that the limits can be checked
    state_.setTime(begin);
    integrator.initialize(state_);
    while (failure_.empty() && next_ < run_.times.size() && run_.times[next_] < end) {
      if (stepTo(integrator, run_.times[next_])) {
        record(integrator.getState());
      }
    }
    if (failure_.empty() && stepTo(integrator, end)) {
      state_ = integrator.getAdvancedState();
    }
    steps_before_ += integrator.getNumStepsAttempted();
  }

  /// False if a limit was reached before.
  bool stepTo(SimTK::Integrator& integrator, double t) {
    while (integrator.getTime() < t) {
      integrator.stepTo(t);
      failure_ = guard_.check(steps_before_ + integrator.getNumStepsAttempted(), integrator.getTime());
      if (!failure_.empty()) {
        return false;
      }
    }
    return true;
  }

  void record(const SimTK::State& state) {
    run_.system.getTree().getSystem().realize(state, SimTK::Stage::Velocity);
    run_.record(static_cast<int>(next_), run_.times[next_], state);
    ++next_;
  }

  const SampleRun& run_;
  IntegrationOptions options_;
  IntegrationGuard guard_;
  SimTK::State state_;
  std::string failure_;
  int steps_before_ = 0;
  Eigen::Index next_ = 0;
};

}  // namespace

std::string runSimbody(const SampleRun& run) {
  return SimbodyRun(run).run();
}

}  // namespace twinmap
