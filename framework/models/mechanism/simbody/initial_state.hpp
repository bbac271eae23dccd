#pragma once

#include "framework/models/mechanism/equilibrium.hpp"
#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

/// As solveEquilibrium(RestAccelerations), by Simbody, with a central-difference Jacobian. Cost: 2 n + 1
/// accelerations an iteration.
Eigen::VectorXd solveEquilibrium(LoadedSystem& system, const Eigen::VectorXd& start);

/// With the loops of the machine closed: its dependent coordinates and rates are moved (Assembly). Throws
/// SimulationFailure where that cannot be.
InitialState assemble(SimbodyContext& context, InitialState initial);

/// The initial state of a sample as its spec says; `box_center`: coordinates of the equilibrium at the box
/// centre, used if the spec asks for that.
InitialState calcInitialState(SimbodyContext& context, LoadedSystem& system,
                              const Eigen::VectorXd& box_center);

/// Writes coordinates and speeds into a Simbody state and realizes it to Velocity. Throws SimulationFailure
/// where the coordinates are singular (the middle angle of three at +-90 degrees).
void setState(const LoadedSystem& system, const InitialState& initial, SimTK::State& state);

}  // namespace twinmap
