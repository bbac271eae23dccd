#include "framework/estimation/posterior/draws/valley_places.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/box_points.hpp"
#include "framework/estimation/posterior/basins/search_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kValues[] = {-0.8, -0.4, 0.0, 0.4, 0.8};  // in half-widths

/// The point of the basin's linear model with coordinate j at a value, where it is nearest to it.
VectorXd startFromNearest(const std::vector<Basin>& basins, Index j, double value) {
  const Basin* nearest = &basins.front();
  for (const Basin& basin : basins) {
    if (std::abs(basin.local.at[j] - value) < std::abs(nearest->local.at[j] - value)) {
      nearest = &basin;
    }
  }
  const VectorXd along = nearest->covariance.col(j) / nearest->covariance(j, j);
  return clampToBox(nearest->local.at + (value - nearest->local.at[j]) * along);
}

}  // namespace

std::vector<LocalSurface> findValleyPlaces(MisfitSurface& surface, const std::vector<Basin>& basins,
                                           std::uint64_t seed) {
  const Index u = surface.getDimensions(), values = static_cast<Index>(std::size(kValues));
  MatrixXd starts(u, 2 * u * values), held(u, starts.cols());
  starts.rightCols(u * values) = makeStarts(u, seed, static_cast<int>(u * values));  // that know of no basin
  for (Index i = 0; i < u * values; ++i) {
    const Index j = i / values;
    starts.col(i) = startFromNearest(basins, j, kValues[i % values]);
    for (const Index column : {i, u * values + i}) {
      starts(j, column) = kValues[i % values];
      held.col(column) = VectorXd::Unit(u, j);
    }
  }
  SearchTeam team(surface, starts, held);
  team.run(kFewIterations);
  std::vector<LocalSurface> places = team.listEnds();
  const auto bears = [&](const LocalSurface& end) {
    return end.misfit < basins.front().local.misfit + kBasinAbove;
  };
  places.erase(std::stable_partition(places.begin(), places.end(), bears), places.end());
  return places;
}

}  // namespace twinmap
