#pragma once

#include <Eigen/Core>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap::testing {

/// The reference case of Kessels et al. (2022): parameters d_y, d_theta, k_y, k_theta; outputs y and theta.
ModelSpec makeTwoBeam();

/// t = 0.05 i, i = 1..100.
Eigen::VectorXd makeTwoBeamTimes();

/// `count` points, uniform in the parameter box (4 x count), the same on every call.
Eigen::MatrixXd makeTwoBeamPoints(int count);

/// Coordinates (y, theta) of the static equilibrium at a parameter point, to rounding.
Eigen::Vector2d calcTwoBeamEquilibrium(const Eigen::Vector4d& parameters);

/// (y, theta) at `times` (2 x times) from the closed-form equations of motion: classical Runge-Kutta of order
/// 4 with 100 microseconds a step, restarted at 0.2 s and 0.25 s; its error is below 1e-9 of each range.
Eigen::MatrixXd integrateTwoBeam(const Eigen::Vector4d& parameters, const Eigen::VectorXd& times,
                                 double step_s = 1e-4);

}  // namespace twinmap::testing
