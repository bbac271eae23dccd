#pragma once

#include <utility>
#include <vector>

#include "framework/estimation/posterior/basins/basin.hpp"

namespace twinmap {

/// Pairs of basins (their places in the list) that a valley connects: from each basin to the nearest of those
/// before it chi-square rises by less than 4, as it does between two normal distributions that are four
/// standard deviations apart. It is looked at at five points of the straight way, each corrected at right
/// angles to it (SearchTeam). Without, a quarter of the measurements of a pendulum of which m L g and J + m
/// L^2 alone are determined are called multimodal. Cost: some 15 simulations and 4 with derivatives a point.
std::vector<std::pair<std::size_t, std::size_t>> findConnections(MisfitSurface& surface,
                                                                 const std::vector<Basin>& basins);

}  // namespace twinmap
