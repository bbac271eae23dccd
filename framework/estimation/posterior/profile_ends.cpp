#include "framework/estimation/posterior/profile_ends.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/posterior/search_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Points (u x n) that are put off from the mean of the draws in one coordinate each, the others as the
/// draws go along with it; and the coordinates, as unit vectors.
struct Ends {
  MatrixXd points, coordinates;
};

Ends listEnds(const importance::WeightedDraws& draws) {
  constexpr double kReach = 5.0, kLeastReach = 0.8 * kReach;  // standard deviations
  const VectorXd mean = importance::calcMean(draws);
  const MatrixXd covariance = importance::calcCovariance(draws);
  const Index u = mean.size();
  Ends ends{MatrixXd(u, 2 * u), MatrixXd(u, 2 * u)};
  Index count = 0;
  for (Index j = 0; j < u; ++j) {
    const double stddev = std::sqrt(covariance(j, j));
    for (const double side : {-1.0, 1.0}) {
      const double apart = std::min(kReach * stddev, 1.0 - side * mean[j]);
      if (stddev > 0.0 && apart >= kLeastReach * stddev) {
        const VectorXd point = mean + side * apart * covariance.col(j) / covariance(j, j);
        ends.points.col(count) = point.cwiseMax(-1.0).cwiseMin(1.0);
        ends.coordinates.col(count++) = VectorXd::Unit(u, j);
      }
    }
  }
  return {ends.points.leftCols(count), ends.coordinates.leftCols(count)};
}

}  // namespace

bool endTooEarly(MisfitSurface& surface, const importance::WeightedDraws& draws, double least_misfit) {
  constexpr int kIterations = 6;
  constexpr double kProfileRise = 1.5;
  const Ends ends = listEnds(draws);
  if (ends.points.cols() == 0) {
    return false;
  }
  SearchTeam team(surface, ends.points, ends.coordinates);
  team.run(kIterations);
  const std::vector<LocalSurface> profile = team.listEnds();
  return std::any_of(profile.begin(), profile.end(),
                     [&](const LocalSurface& local) { return local.misfit < least_misfit + kProfileRise; });
}

}  // namespace twinmap
