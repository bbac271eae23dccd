#pragma once

#include <Eigen/Core>

namespace twinmap {

inline constexpr const char* kSingularMassMatrix =
    "the mass matrix is singular: a body without inertia can move freely";

/// How far a condition of a loop that is open counts as an acceleration where equilibria are solved for, in
/// 1/s2: 1e-11 m then count as the 1e-9 m/s2 that are taken for rounding.
inline constexpr double kClosureWeight = 100.0;

/// The accelerations of a system at rest, at t = 0 and without excitation, then the rates of its states of
/// first order, and what loops are open by, which must vanish too; and their derivatives with respect to
/// [coordinates; states]. Throw SimulationFailure if the mass matrix or a loop is singular.
class RestAccelerations {
 public:
  virtual ~RestAccelerations() = default;
  virtual Eigen::VectorXd calc(const Eigen::VectorXd& at) = 0;
  virtual Eigen::MatrixXd calcJacobian(const Eigen::VectorXd& at) = 0;
};

/// Where a state of first order has no rate whatever the others are, as friction's at rest, it stays where it
/// is: its column of `jacobian` becomes zero. `rates`: accelerations of `coordinates` coordinates, then those
/// of the states.
void holdIndifferentStates(const Eigen::VectorXd& rates, Eigen::Index coordinates, Eigen::MatrixXd& jacobian);

/// [coordinates; speeds; states] from [coordinates; states].
Eigen::VectorXd insertSpeeds(const Eigen::VectorXd& equilibrium, const Eigen::VectorXd& speeds);

/// The coordinates, then the states of first order, at which all accelerations and rates vanish: damped
/// Newton from `start`. Directions that no force depends on keep their start, as do indifferent states.
/// Throws SimulationFailure, with the residual, if it does not converge. Usually 4 to 6 iterations.
Eigen::VectorXd solveEquilibrium(RestAccelerations& system, const Eigen::VectorXd& start);

}  // namespace twinmap
