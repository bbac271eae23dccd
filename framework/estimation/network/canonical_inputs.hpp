#pragma once

#include <Eigen/Core>

#include "kernels/network/network.hpp"

namespace twinmap {

/// Combinations of measurements in the order in which polynomials of the parameters explain them: canonical
/// variates (Hotelling 1936). A strongly nonlinear response has few that follow the parameters smoothly, and
/// they need not be those of the largest variance.
struct CanonicalInputs {
  Eigen::MatrixXd projection;    ///< k x k: uncorrelated inputs of unit variance from centred ones
  Eigen::VectorXd correlations;  ///< k, descending: each input's with its best polynomial, in [0, 1]
};

/// Of inputs (k x n, centred) at points (m x n, in any units): the polynomials are of the third degree, or of
/// the second or first where there are fewer than four samples a term. Directions in which inputs do not vary
/// give 0. Cost: (k + terms)^2 n + (k + terms)^3 flops.
CanonicalInputs calcCanonicalInputs(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& points);

/// Whether there are four samples for each term of a polynomial.
bool sufficeFor(Eigen::Index variables, const network::Products& products, Eigen::Index samples);

}  // namespace twinmap
