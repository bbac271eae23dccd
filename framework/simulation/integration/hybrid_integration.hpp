#pragma once

#include "framework/simulation/integration/integration.hpp"
#include "framework/simulation/integration/make_hybrid_stepper.hpp"

namespace twinmap {

/// An OdeProblem whose state may jump at events. Indicators z(t, x) are smooth between events; where one
/// changes from z > 0 to z <= 0 or back there is a state event.
class HybridProblem : public OdeProblem {
 public:
  virtual std::size_t getIndicatorCount() const = 0;
  virtual void calcIndicators(double t, const State& x, double* indicators) = 0;

  /// A step of the integration ended at t with x; no evaluation before t follows. True if an event is due
  /// here.
  virtual bool completeStep(double t, const State& x) = 0;

  /// An event at t: may change x.
  virtual void handleEvent(double t, State& x) = 0;

  /// The phase that begins at a boundary, which may change x.
  virtual void enterPhase(double begin, State& x) = 0;
  void beginPhase(double) final {}

  /// The next time event after enterPhase() and handleEvent(), s; infinity if none is known.
  virtual double getNextEventTime() const = 0;

  /// The problem ended its own simulation.
  virtual bool isOver() const = 0;
};

struct HybridReport : IntegrationReport {
  int state_events = 0;             ///< without any, `sequence` can be given to neighbours
  bool reached_step_limit = false;  ///< the failure that stiffness has with an explicit method
};

/// As integrateDopri5 for a problem with events. Time events are met exactly. State events are looked for at
/// four points of every step and located on its dense output, to a few units in the last place of t; the
/// integration restarts after each event. Outputs at the time of an event are those after it.
/// `given`: the steps of another integration instead of an error control, as in replayDopri5; null: none. It
/// then fails where a state event comes, or another number of phases and time events.
/// Fails as integrateDopri5 does, if events follow one another without any progress, and if the problem is
/// over before the last output.
HybridReport integrateHybrid(HybridProblem& problem, OdeProblem::State x,
                             const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                             const IntegrationOptions& options, const StepSequence* given = nullptr,
                             HybridMethod method = HybridMethod::kExplicit);

}  // namespace twinmap
