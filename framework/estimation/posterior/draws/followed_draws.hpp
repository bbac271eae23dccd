#pragma once

#include <cstdint>

#include "framework/estimation/posterior/basins/basin_search.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

/// Draws of equal weight along a valley of many parameters that bends by far more than it is wide. Those of
/// the linear response (drawLinear) are each led to the nearest point, as the prior measures, where the
/// simulator responds as the linear response did there. What is determined has the noise's spread, what is
/// not its prior: randomised measurements and priors, minimised (Oliver, He and Reynolds 1996). The weights
/// of randomized_minima.hpp leave one draw of a hundred bent directions. Reliable where most arrive: the
/// noise does not tell their response from that wanted. Cost: some three simulations with derivatives a draw,
/// at few of the times where that is enough (MeasuredMisfit::makeThinned).
importance::AdaptiveDraws drawFollowed(MisfitSurface& surface, const Basin& basin, int draws,
                                       std::uint64_t seed);

}  // namespace twinmap
