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
constexpr Index kElsewhere = 2;                            // starts a value that know of no basin

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
  const Index starts_per_value = 1 + kElsewhere;
  const MatrixXd elsewhere = makeStarts(u, seed, static_cast<int>(u * values * kElsewhere));
  MatrixXd starts(u, u * values * starts_per_value), held(u, starts.cols());
  for (Index j = 0, column = 0; j < u; ++j) {
    for (Index v = 0; v < values; ++v) {
      const double value = kValues[v];
      starts.col(column) = startFromNearest(basins, j, value);
      starts.middleCols(column + 1, kElsewhere) =
          elsewhere.middleCols((j * values + v) * kElsewhere, kElsewhere);
      starts.row(j).segment(column, starts_per_value).setConstant(value);
      held.middleCols(column, starts_per_value) = VectorXd::Unit(u, j).replicate(1, starts_per_value);
      column += starts_per_value;
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
