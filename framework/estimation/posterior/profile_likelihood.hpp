#pragma once

#include <vector>

#include "framework/estimation/posterior/basins/misfit_surface.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

/// The profile likelihood of one parameter: held at a value, the others as they fit best. Where the
/// measurement leaves a direction flat, these are points along it.
struct Profile {
  Eigen::Index parameter = 0;
  Eigen::MatrixXd points;      ///< u x n, all unknown parameters, ascending in the one that is held
  Eigen::VectorXd log_ratios;  ///< n, of the posterior density there over the largest: at most 0
};

/// Of each of the first `count` coordinates, at up to 13 values over three standard deviations of the draws
/// both ways, but no further than the draws' .1 and 99.9 % quantiles. Each value is searched from the four
/// draws nearest to it that bear most weight, so from several modes. `points` are in the coordinates of the
/// surface. Values where nothing could be simulated are left out. Cost: 52 searches of at most 10 iterations
/// a coordinate in one batch, then 26.
std::vector<Profile> calcProfiles(MisfitSurface& surface, const importance::WeightedDraws& draws,
                                  double least_misfit, Eigen::Index count);

}  // namespace twinmap
