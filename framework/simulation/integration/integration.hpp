#pragma once

#include <Eigen/Core>
#include <chrono>
#include <string>
#include <vector>

#include "framework/simulation/integration/ode_problem.hpp"
#include "framework/simulation/simulation_failure.hpp"

namespace twinmap {

/// The sample's limit of wall time was reached: the only failure that depends on the machine and its load, so
/// that another try may succeed.
class WallTimeReached : public SimulationFailure {
 public:
  using SimulationFailure::SimulationFailure;
};

/// Where each step ended, phase by phase, in fractions of the phase: (0, 1], increasing, the last is 1.
using StepSequence = std::vector<std::vector<double>>;

struct IntegrationReport {
  std::string failure;  ///< empty if all outputs were recorded: "step limit of 100 reached at t = 0.3 s"
  int steps = 0;        ///< tried, including rejected ones
  int rejected = 0;
  StepSequence sequence;  ///< the accepted steps
};

/// Integrates from boundaries.front() to boundaries.back() by Dormand and Prince's 5(4) pair with its
/// 4th-order dense output (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, II.5 and
/// II.6), and records the outputs. The integration restarts at every boundary and lands on it exactly.
/// `boundaries` (s): strictly increasing, two or more. `output_times` (s): increasing, within the boundaries.
/// A step with a state or derivative that is not finite is tried again with a tenth of its size. Numerical
/// failure is a text in the report, but for WallTimeReached, which is thrown; exceptions of the problem pass
/// through.
/// Cost: 6 evaluations of f a step, 3 more a phase.
IntegrationReport integrateDopri5(OdeProblem& problem, OdeProblem::State x,
                                  const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                                  const IntegrationOptions& options);

/// As integrateDopri5 with given steps instead of an error control: the result is a smooth function of all
/// that enters the problem. Fails if the boundaries make another number of phases, or where the state becomes
/// non-finite. Cost: 6 evaluations of f a step, 1 more a phase.
IntegrationReport replayDopri5(OdeProblem& problem, OdeProblem::State x,
                               const std::vector<double>& boundaries, const Eigen::VectorXd& output_times,
                               const StepSequence& sequence);

/// Counts steps and wall time; what a failed integration has to say.
class IntegrationGuard {
 public:
  explicit IntegrationGuard(const IntegrationOptions& options);

  /// The reason to stop before step number `steps` + 1 at time t, or "". Throws WallTimeReached.
  std::string check(int steps, double t) const;

 private:
  const IntegrationOptions& options_;
  std::chrono::steady_clock::time_point start_;
};

/// "<what> at t = 0.3 s"
std::string describeAt(const std::string& what, double t);
std::string describeStepLimit(int max_steps, double t);
std::string describeWallTime(double max_wall_time, double t);

}  // namespace twinmap
