#pragma once

#include "kernels/gp/stop.hpp"
#include "kernels/surrogate/fit_shared_process.hpp"
#include "kernels/surrogate/slope_covariance.hpp"

namespace twinmap::gp {

/// Decides whether slopes are learnt from besides values, and with which numbers, by how well points are
/// predicted that are left out with their slopes. From the choice made for the values: the covariance
/// function, the common factor of its length scales and the two nuggets are searched, on at most 900 values
/// and slopes. Where slopes change within the distance of the points, such as those of a chaotic response,
/// they tell nothing: the choice for the values is returned. Cost: some 12 fits (fitJointly).
SharedChoice chooseWithSlopes(const SharedChoice& by_values, const Eigen::MatrixXd& points,
                              const Eigen::MatrixXd& values, const SlopeData& slopes,
                              StopFlag stop = nullptr);

}  // namespace twinmap::gp
