#pragma once

#include <Eigen/Core>

namespace twinmap::optimization {

/// Where g's + s'Cs / 2 is least within lower <= s <= upper: the active-set method for convex quadratic
/// programs (Nocedal and Wright 2006, section 16.5), from s = 0. Coordinates at a bound whose slope points
/// outwards are held there and released where it turns.
/// @param curvature C (n x n), positive definite
/// @param gradient g (n)
/// @param lower,upper (n), lower <= 0 <= upper
/// Exact to rounding; cost some n^3 for each change of what is held, of which there are hardly more than n.
Eigen::VectorXd minimizeQuadratic(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& gradient,
                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace twinmap::optimization
