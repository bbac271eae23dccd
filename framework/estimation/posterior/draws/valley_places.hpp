#pragma once

#include <cstdint>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"

namespace twinmap {

/// Places on the floors of valleys all over the box: each coordinate is held at five values in turn,
/// and the others are searched for the least misfit there, from the nearest basin as its linear model goes
/// along with the value, and from two points of a Sobol sequence. Those that bear some of the posterior, at
/// most 25 in misfit above the best basin. A search that is free to move leaves a valley for its deepest
/// point, wherever in it most of the posterior lies. The starts depend on `seed` alone. Cost: 15 searches of
/// at most 8 iterations a coordinate.
std::vector<LocalSurface> findValleyPlaces(MisfitSurface& surface, const std::vector<Basin>& basins,
                                           std::uint64_t seed);

}  // namespace twinmap
