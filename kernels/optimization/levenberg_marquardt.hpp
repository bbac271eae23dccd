#pragma once

#include <Eigen/Core>
#include <functional>

namespace twinmap::linalg {

/// A vector of residuals r (m) as a function of variables x (n <= m). Either call ends the search by
/// returning false.
struct ResidualFunction {
  Eigen::Index residuals = 0;                                                ///< m
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& r)> calc;    ///< r is m long
  std::function<bool(const Eigen::VectorXd& x, Eigen::MatrixXd& j)> derive;  ///< dr / dx, m x n
};

struct LevenbergMarquardtOptions {
  double tolerance = 1e-6;  ///< relative, of |r|^2 and of x: where the search ends
  double first_step = 1.0;  ///< bound of the first step, in units of |D x| (MINPACK's `factor`)
};

/// Searches a minimum of |r(x)|^2 from `x`, which it moves there, by Levenberg and Marquardt's method
/// (Eigen's port of MINPACK's lmder). False if the search did not converge. Cost beside the calls: about 2 m
/// n^2 flops a derivative.
bool minimizeSquares(const ResidualFunction& function, const LevenbergMarquardtOptions& options,
                     Eigen::VectorXd& x);

}  // namespace twinmap::linalg
