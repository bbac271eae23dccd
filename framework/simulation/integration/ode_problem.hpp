#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

struct IntegrationOptions {
  double relative_tolerance = 3e-7;  ///< local error per step, relative to the state
  double absolute_tolerance = 1e-9;  ///< and absolute, in the state's own units
  int max_steps = 100000;            ///< tried steps of all phases together
  double max_wall_time = 60.0;       ///< s
};

/// x' = f(t, x) with f smooth within each phase, and what to do with the solution.
class OdeProblem {
 public:
  using State = std::vector<double>;

  virtual ~OdeProblem() = default;

  /// Switches f to the phase that begins at `begin` (s). Called before any evaluation within it.
  virtual void beginPhase(double begin) = 0;
  virtual void calcDerivative(double t, const State& x, State& dxdt) = 0;
  /// df/dx (n x n, already of that size); false where the problem does not know it. What needs it then takes
  /// differences.
  virtual bool calcJacobian(double, const State&, Eigen::MatrixXd&) { return false; }
  /// The solution at output time `index`. At an event it belongs to the phase that begins there.
  virtual void recordOutput(int index, double t, const State& x) = 0;
};

}  // namespace twinmap
