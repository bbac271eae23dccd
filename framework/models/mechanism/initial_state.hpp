#pragma once

#include <Eigen/Core>

#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

/// Coordinates and their time derivatives in the order of SystemNames.
struct InitialState {
  Eigen::VectorXd coordinates, speeds;
};

/// Values of the initial condition at the current parameter set, without any equilibrium. Throws
/// ExperimentError for a name that is no coordinate, SimulationFailure for values that are not finite.
InitialState calcInitialValues(ModelContext& context);

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

/// The same by Simbody, with a central-difference Jacobian. Cost: 2 n + 1 accelerations an iteration.
Eigen::VectorXd solveEquilibrium(LoadedSystem& system, const Eigen::VectorXd& start);

/// The initial state of a sample as its spec says; `box_center`: coordinates of the equilibrium at the box
/// centre, used if the spec asks for that.
InitialState calcInitialState(ModelContext& context, LoadedSystem& system, const Eigen::VectorXd& box_center);

/// Writes coordinates and speeds into a Simbody state and realizes it to Velocity. Throws SimulationFailure
/// where the coordinates are singular (the middle angle of three at +-90 degrees).
void setState(const LoadedSystem& system, const InitialState& initial, SimTK::State& state);

}  // namespace twinmap
