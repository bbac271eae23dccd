#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/basins/misfit_surface.hpp"

namespace twinmap {

/// More unknown parameters than these are searched for and drawn by means of the prior: no mixture follows so
/// many dimensions, and no starts cover them.
constexpr Eigen::Index kManyUnknown = 16;

/// Points on the way from one basin to another, at which chi-square is asked.
constexpr Eigen::Index kWayPoints = 3;

/// A minimum of chi-square within the bounds.
struct Basin {
  LocalSurface local;
  Eigen::MatrixXd covariance;  ///< u x u: of the linear model (BoundedInformation)
  int searches = 0;            ///< that ended in it
};

/// From its best point, in its standard deviations.
double calcDistance(const Basin& basin, const Eigen::VectorXd& at);

/// Whether a point is within kBasinReach standard deviations of a basin's minimum.
bool liesIn(const Basin& basin, const Eigen::VectorXd& at);

/// The ends of searches that may bear some of the posterior, at most 25 above the best and 12 of them, each
/// basin once: an end within three standard deviations of a better one is in its basin.
std::vector<Basin> collectBasins(std::vector<LocalSurface> ends);

}  // namespace twinmap
