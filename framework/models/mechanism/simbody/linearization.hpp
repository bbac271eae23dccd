#pragma once

#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

/// The matrix A of x' = A x for x = [coordinates; their time derivatives; states of first order] (in the
/// order of SystemNames) around rest at an equilibrium [coordinates; states], t = 0 and without excitation:
/// by central differences of the accelerations, exact to some 1e-10 relative for forces that are linear.
/// Cost: 4 n accelerations.
Eigen::MatrixXd calcStateMatrix(LoadedSystem& system, const Eigen::VectorXd& equilibrium);

}  // namespace twinmap
