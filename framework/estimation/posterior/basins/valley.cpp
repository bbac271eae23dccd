#include "framework/estimation/posterior/basins/valley.hpp"

#include <algorithm>
#include <limits>

#include "framework/estimation/posterior/basins/search_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

std::size_t findNearestBefore(const std::vector<Basin>& basins, std::size_t k) {
  const VectorXd& at = basins[k].local.at;
  const auto end = basins.begin() + static_cast<std::ptrdiff_t>(k);
  const auto nearest = std::min_element(basins.begin(), end, [&](const Basin& a, const Basin& b) {
    return (a.local.at - at).squaredNorm() < (b.local.at - at).squaredNorm();
  });
  return static_cast<std::size_t>(nearest - basins.begin());
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> findConnections(MisfitSurface& surface,
                                                                 const std::vector<Basin>& basins) {
  std::vector<std::pair<std::size_t, std::size_t>> connected;
  if (basins.size() < 2) {
    return connected;
  }
  const Index u = surface.getDimensions(), ways = static_cast<Index>(basins.size()) - 1;
  MatrixXd starts(u, ways * kWayPoints), held(u, starts.cols());
  for (Index i = 0; i < ways; ++i) {
    const auto to = static_cast<std::size_t>(i) + 1;
    const VectorXd& from = basins[findNearestBefore(basins, to)].local.at;
    const VectorXd apart = basins[to].local.at - from;
    for (Index k = 0; k < kWayPoints; ++k) {
      starts.col(i * kWayPoints + k) = from + static_cast<double>(k + 1) / (kWayPoints + 1) * apart;
      held.col(i * kWayPoints + k) = apart.normalized();
    }
  }
  SearchTeam team(surface, starts, held);
  team.run(kFewIterations);
  for (Index i = 0; i < ways; ++i) {
    const auto to = static_cast<std::size_t>(i) + 1, from = findNearestBefore(basins, to);
    double highest = 0.0;
    for (Index k = 0; k < kWayPoints; ++k) {
      const LocalSurface& local = team.getLocal(i * kWayPoints + k);
      highest = std::max(highest, local.simulated ? local.misfit : std::numeric_limits<double>::infinity());
    }
    if (highest < std::max(basins[from].local.misfit, basins[to].local.misfit) + kBarrier) {
      connected.emplace_back(from, to);
    }
  }
  return connected;
}

}  // namespace twinmap
