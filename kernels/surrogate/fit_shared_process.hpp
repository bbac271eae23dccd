#pragma once

#include <Eigen/Core>

#include "kernels/gp/stop.hpp"
#include "kernels/surrogate/shared_covariance.hpp"

namespace twinmap::gp {

/// A search takes no more points than these.
inline constexpr Eigen::Index kSearchPoints = 300;

/// Structure and numbers that predict points left out best.
struct SharedChoice {
  SharedStructure structure;
  SharedHyperparameters hyperparameters;
  double negative_log_density = 0.0;  ///< LeftOutDensity, of the points searched
};

/// Chooses covariance function, trend, length scales and nugget for `values` (n x r, in units of their
/// measurement's noise) at `points` (p x n, within about [-1, 1]) by LeftOutDensity and L-BFGS, on at most
/// 300 points. A quadratic trend is tried where the points are four times its terms. Throws
/// std::invalid_argument for fewer points than linear terms + 2, std::runtime_error where no structure can be
/// fitted. Cost: some 40 evaluations.
SharedChoice chooseSharedProcess(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values,
                                 StopFlag stop = nullptr);

/// The two halves of it: the choice on at most 300 points, and where there are more, 8 further evaluations
/// with all of them, which take most of the time.
SharedChoice chooseOnSpread(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values,
                            StopFlag stop = nullptr);
SharedChoice finishOnAll(const SharedChoice& found, const Eigen::MatrixXd& points,
                         const Eigen::MatrixXd& values, StopFlag stop = nullptr);

/// The same from a choice made on similar data: its structure, and a few steps from its numbers; where the
/// points are more than 300, such as the rest of a cross-validation, its numbers as they are.
SharedChoice adaptSharedProcess(const SharedChoice& similar, const Eigen::MatrixXd& points,
                                const Eigen::MatrixXd& values, StopFlag stop = nullptr);

}  // namespace twinmap::gp
