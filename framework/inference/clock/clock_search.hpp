#pragma once

#include "framework/inference/nuisance_search.hpp"

namespace twinmap {

/// The faults of a recorder's clock that explain a measurement which the stated noise does not: a delay, a
/// rate, both, or slips (as many as one in twenty samples, at most 40, each with odds of a thousand to one
/// against chance anywhere), the fewest first. One clock for all outputs. Cost: some 10 simulators made, each
/// linearised once, for each fault.
NuisanceSearch findClockFaults;

}  // namespace twinmap
