#pragma once

#include <Eigen/Core>

#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

// The model at the centre of its parameter box. What cannot exist there is wrong input: all of these throw
// ExperimentError, with the place of the number that is the cause where one is.

/// Builds everything, so that all expressions are compiled and all names are known.
void buildAtBoxCenter(SimbodyContext& context);

/// Coordinates of the equilibrium that all samples start from; empty if the spec does not ask for it.
Eigen::VectorXd solveBoxCenter(SimbodyContext& context);

/// The initial state exists and its accelerations are finite. `box_center`: of solveBoxCenter().
void checkStartAtBoxCenter(SimbodyContext& context, const Eigen::VectorXd& box_center);

}  // namespace twinmap
