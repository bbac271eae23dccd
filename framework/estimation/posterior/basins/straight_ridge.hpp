#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"

namespace twinmap {

/// Where the measurement determines but a combination of parameters, its ridge is straight in the logarithms
/// if that is a product or a quotient, and in the parameters themselves if it is a sum.
struct RidgeShape {
  std::vector<Eigen::Index> plain;  ///< parameters that make it straighter as they are; empty: logarithms do
  /// Whether it is straight then: a standard deviation along it turns it by less than its own thickness.
  bool is_straight = true;
};

/// The shape of the flattest direction of a basin, and of all that are known by the bounds rather than by the
/// measurement. With the information I one standard deviation further on, at p, a direction d (that long)
/// of the basin costs d' I d of misfit; the ridge is straight where this hardly grows. In the parameters d_j
/// is d_j x_j / x_j(p) there, so that one linearisation serves for all choices of them, of which the one with
/// the least growth is taken if it halves that of the logarithms. Cost: two simulations with derivatives a
/// direction and 2^k quadratic forms for k parameters that take part, at most 10.
RidgeShape findRidgeShape(MisfitSurface& surface, const Basin& basin);

/// A basin with the bounds in place of a normal distribution of the box along the directions that are level,
/// for they are known by the bounds: its centre and covariance along each are those of the normal
/// distribution of the linear model cut off at the bounds, but no narrower than before. So draws reach both
/// ends of the ridge wherever on it the search ended.
Basin levelBasin(const Basin& basin);

}  // namespace twinmap
