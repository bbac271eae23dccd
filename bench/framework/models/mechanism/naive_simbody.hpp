#pragma once

#include <Eigen/Core>

namespace twinmap::bench {

/// The two-beam case as a user of Simbody would write it first: a system built for the parameter set, force
/// elements with a time test for the pulses, and a TimeStepper around RungeKuttaMerson that reports at the
/// given times. Returns (y, theta), 2 x times. `start_theta`: rad.
Eigen::MatrixXd simulateNaively(const Eigen::Vector4d& parameters, const Eigen::VectorXd& times,
                                double start_theta, double accuracy);

}  // namespace twinmap::bench
