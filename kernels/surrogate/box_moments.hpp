#pragma once

#include <Eigen/Core>

namespace twinmap::gp {

/// Mean and covariance of a distribution of u variables.
struct Moments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Moments of the density proportional to exp(-x' Q x / 2 + b' x) within the box [-1, 1]^u and 0 outside,
/// with Q (u x u) positive semi-definite: a normal likelihood under a uniform prior. By expectation
/// propagation, one normal factor for each variable's two bounds (Minka 2001; Cunningham, Hennig and
/// Lacoste-Julien 2011), exact for a single variable. Where Q says nothing of a variable, it is uniform.
/// Cost: some 5 u (u^2 + 65 exponentials).
Moments calcBoxMoments(const Eigen::MatrixXd& precision, const Eigen::VectorXd& shift);

}  // namespace twinmap::gp
