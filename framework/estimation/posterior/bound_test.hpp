#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/basins/misfit_surface.hpp"

namespace twinmap {

/// Coordinates that would leave the bounds if they could, where chi-square then falls by more than noise
/// explains (once in a hundred measurements of a machine at the bound): by the linear model at a minimum
/// within them, all together, or one alone. Ascending; empty where noise may have driven the minimum to the
/// bounds.
std::vector<Eigen::Index> findBeyondBounds(const LocalSurface& minimum);

}  // namespace twinmap
