#pragma once

#include "framework/simulation/integration/ode_problem.hpp"

namespace twinmap {

/// One step of a method of integration, with its dense output. Not thread safe.
class HybridStepper {
 public:
  using State = OdeProblem::State;

  /// Where a step begins, and where it ends.
  struct Point {
    double t = 0.0;  ///< s
    State x, dxdt;
  };

  virtual ~HybridStepper() = default;

  /// Tries a step of size dt from `from`; true: `to` is its end, within the tolerances. dt becomes the size
  /// to try next, or again.
  virtual bool tryStep(OdeProblem& problem, const Point& from, Point& to, double& dt) = 0;
  /// A step to `t_new` without error control.
  virtual void doStep(OdeProblem& problem, const Point& from, double t_new, Point& to) = 0;
  /// The solution at t on the last step, from `from` to `to`.
  virtual void interpolate(double t, const Point& from, const Point& to, State& x) = 0;
  /// Whether it is as accurate there as at the end; else steps should end at outputs.
  virtual bool interpolatesAccurately() const { return true; }
};

}  // namespace twinmap
