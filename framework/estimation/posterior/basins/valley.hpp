#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"

namespace twinmap {

/// The floors of valleys: where chi-square is least on the way from one basin to another, and along the
/// flattest direction of a basin whose valley is bent.
struct Valleys {
  /// Points of the floors, each as a basin of its own, as long as its part of the valley; chi-square at most
  /// 25 above the best.
  std::vector<Basin> floors;
  /// Pairs of basins (their places in the list) that a valley connects: chi-square rises by less than 4 on
  /// the way, as it does between two normal distributions that are four standard deviations apart.
  std::vector<std::pair<std::size_t, std::size_t>> connected;
};

/// From each basin to the nearest of those before it, and along the flattest direction of each where
/// chi-square rises other than its linear model says: points of the straight way, each corrected at right
/// angles to it by Gauss-Newton steps (SearchTeam). They are also points of the profile likelihood. Cost:
/// some 15 simulations and 4 with derivatives a point, five points a basin.
Valleys followValleys(MisfitSurface& surface, const std::vector<Basin>& basins);

}  // namespace twinmap
