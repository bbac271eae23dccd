#pragma once

#include <vector>

#include "framework/estimation/posterior/basins/misfit_surface.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

/// Whether draws end where the posterior goes on, as those of a bent valley do that were drawn in a small
/// part of it alone: nothing in their own weights shows that. Each coordinate is held five standard
/// deviations of the draws from their mean, both ways, and the others are searched for the least misfit
/// there: a point of the profile likelihood. Of a normal posterior it lies 25 above the least of all; of
/// right draws of valleys with several flat directions it was seen to lie 1.8 and more above, of draws of a
/// quarter of a valley .05 to 1. Coordinates whose bound lies nearer than four standard deviations say
/// nothing: the bound ends them. Cost: a search of at most 6 iterations for each end.
bool endTooEarly(MisfitSurface& surface, const importance::WeightedDraws& draws, double least_misfit);

/// The profile likelihood of one parameter: held at a value, the others as they fit best. Where the
/// measurement leaves a direction flat, these are points along it.
struct Profile {
  Eigen::Index parameter = 0;
  Eigen::MatrixXd points;      ///< u x n, all unknown parameters, ascending in the one that is held
  Eigen::VectorXd log_ratios;  ///< n, of the posterior density there over the largest: at most 0
};

/// Of each of the first `count` coordinates, at up to 13 values over three standard deviations of the draws
/// both ways, but no further than the draws' .1 and 99.9 % quantiles. Each value is searched from the four
/// draws nearest to it that bear most weight, so from several modes, then from what was found at the values
/// beside it. `points` are in the coordinates of the surface. Values where nothing could be simulated are
/// left out. Cost: 52 searches of at most 10 iterations a coordinate in one batch, then 26.
std::vector<Profile> calcProfiles(MisfitSurface& surface, const importance::WeightedDraws& draws,
                                  double least_misfit, Eigen::Index count);

}  // namespace twinmap
