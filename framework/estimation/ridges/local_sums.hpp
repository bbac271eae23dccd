#pragma once

#include <vector>

#include "framework/estimation/ridges/combination.hpp"
#include "framework/estimation/ridges/flat_directions.hpp"

namespace twinmap {

/// What is determined at the first point beside the combinations, as sums of the parameters (Gauss-Jordan
/// elimination, so that they are short). It holds near that point alone. Cost: 9 g^3 flops.
std::vector<Combination> findLocalSums(const FlatDirections& flat,
                                       const std::vector<Combination>& combinations,
                                       const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
