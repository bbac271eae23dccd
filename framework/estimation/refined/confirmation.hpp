#pragma once

#include <optional>

#include "framework/estimation/refined/misfit.hpp"
#include "framework/estimation/refined/search.hpp"

namespace twinmap {

/// Finds and tests a minimum near `start` (s, half-widths) by the same simulations, where a covariance (s x
/// s, half-widths) tells about how far the answer may be: simulations two standard deviations on both sides
/// of a point, along the covariance's eigenvectors, give the linear model by central differences over the
/// very distance for which it is needed, and the rises that testMinimum() asks for. A Gauss-Newton step leads
/// to the next point, its covariance is that of the last one. Nothing, where that has not converged to an
/// accepted minimum within four points, and where less than one standard deviation is left to the limits
/// of the box: then search() has to.
/// The misfit's window must have a whitener. Cost: 2 s + 1 simulations a point, one batch; two points from
/// the answer of a good map.
std::optional<SearchEnd> confirm(Misfit& misfit, const Eigen::VectorXd& start, Eigen::MatrixXd covariance);

}  // namespace twinmap
