#pragma once

#include <Eigen/Core>

namespace twinmap::gp {

/// A polynomial of p variables whose coefficients are found beside the process: 1 and the variables, or their
/// products of two as well.
enum class Trend { kLinear, kQuadratic };

/// q: p + 1, or (p + 1)(p + 2) / 2.
Eigen::Index countTerms(Trend trend, Eigen::Index variables);

/// The terms 1, x_1 ... x_p, x_1 x_1, x_1 x_2 ... of points (p x n), q x n.
Eigen::MatrixXd calcTerms(Trend trend, const Eigen::MatrixXd& points);

/// Derivatives of the terms at a point (p): q x p, resized.
void calcTermDerivatives(Trend trend, const Eigen::Ref<const Eigen::VectorXd>& point,
                         Eigen::MatrixXd& derivatives);

}  // namespace twinmap::gp
