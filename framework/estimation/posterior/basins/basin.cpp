#include "framework/estimation/posterior/basins/basin.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/bounded_information.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double calcDistance(const Basin& basin, const VectorXd& at) {
  const VectorXd apart = at - basin.local.at;
  return std::sqrt(apart.dot(linalg::solvePositiveDefinite(basin.covariance, apart)));
}

bool liesIn(const Basin& basin, const VectorXd& at) {
  return calcDistance(basin, at) < kBasinReach;
}

std::vector<Basin> collectBasins(std::vector<LocalSurface> ends) {
  std::stable_sort(ends.begin(), ends.end(),
                   [](const LocalSurface& a, const LocalSurface& b) { return a.misfit < b.misfit; });
  std::vector<Basin> basins;
  for (LocalSurface& end : ends) {
    if (end.misfit > ends.front().misfit + kBasinAbove) {
      break;
    }
    const auto known =
        std::find_if(basins.begin(), basins.end(), [&](const Basin& basin) { return liesIn(basin, end.at); });
    if (known != basins.end()) {
      ++known->searches;
    } else {
      MatrixXd covariance = BoundedInformation(end.information).calcCovariance();
      basins.push_back({end, std::move(covariance), 1});
    }
  }
  return basins;
}

}  // namespace twinmap
