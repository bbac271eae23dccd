#pragma once

#include <Eigen/Core>

namespace twinmap {

inline constexpr const char* kSingularMassMatrix =
    "the mass matrix is singular: a body without inertia can move freely";

/// The accelerations of a system at rest, at t = 0 and without excitation, and their derivatives with respect
/// to the coordinates. Throw SimulationFailure if the mass matrix is singular.
class RestAccelerations {
 public:
  virtual ~RestAccelerations() = default;
  virtual Eigen::VectorXd calc(const Eigen::VectorXd& coordinates) = 0;
  virtual Eigen::MatrixXd calcJacobian(const Eigen::VectorXd& coordinates) = 0;
};

/// The coordinates at which all accelerations vanish: damped Newton from `start`. Directions that no force
/// depends on keep their start. Throws SimulationFailure, with the residual, if it does not converge. Usually
/// 4 to 6 iterations.
Eigen::VectorXd solveEquilibrium(RestAccelerations& system, const Eigen::VectorXd& start);

}  // namespace twinmap
