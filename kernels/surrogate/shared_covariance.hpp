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

/// exp(-s / 2), or (1 + sqrt(5 s) + 5 s / 3) exp(-sqrt(5 s)), of s = sum over variables of (x - z)^2 / l^2.
enum class SmoothCovariance { kSquaredExponential, kMatern52 };

/// What the functions of a shared process have in common besides numbers.
struct SharedStructure {
  SmoothCovariance covariance = SmoothCovariance::kSquaredExponential;
  Trend trend = Trend::kLinear;
  bool slopes = false;  ///< learnt from slopes as well, where they are known
};

/// Length scales l (p), and the variance of what is not smooth, over that of the process: of values, and of
/// slopes times length scales.
struct SharedHyperparameters {
  Eigen::VectorXd length_scales;
  double nugget = 0.0;
  double slope_nugget = 0.0;
};

/// Replaces scaled squared distances s by covariances k, and gives g = -2 dk / ds: the derivative of k with
/// respect to log l is g (x - z)^2 / l^2, with respect to x it is -g (x - z) / l^2.
void calcSmoothCovariance(SmoothCovariance covariance, Eigen::Ref<Eigen::ArrayXd> squares_to_values,
                          Eigen::Ref<Eigen::ArrayXd> slopes);

/// The same, and the curvatures h = -2 dg / ds.
void calcSmoothCovariance(SmoothCovariance covariance, Eigen::Ref<Eigen::ArrayXd> squares_to_values,
                          Eigen::Ref<Eigen::ArrayXd> slopes, Eigen::Ref<Eigen::ArrayXd> curvatures);

/// Covariances K (n x n, nugget on the diagonal) and slopes g of points (p x n), the distances by
/// differences: products of coordinates would lose the half of their digits that close points differ in.
/// Cost: n^2 (p + 20) flops.
void calcSharedCovariance(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                          const Eigen::MatrixXd& points, Eigen::MatrixXd& covariance,
                          Eigen::MatrixXd& slopes);

}  // namespace twinmap::gp
