#pragma once

#include <Eigen/Core>

#include "kernels/surrogate/shared_covariance.hpp"

namespace twinmap::gp {

/// n values of r functions at points that are left out one at a time, trend fitted anew (Rasmussen and
/// Williams eqs. 5.10 to 5.12): with P = K^-1 - K^-1 H' (H K^-1 H')^-1 H K^-1 and a = P s,
///   e_ij = a_ij / P_ii,   variance_ij = t_j / P_ii,   t_j = mean over i of e_ij^2 P_ii.
struct LeftOut {
  Eigen::MatrixXd residual;   ///< e, n x r
  Eigen::VectorXd variance;   ///< 1 / P_ii, n: of a process of unit variance, nugget included
  Eigen::VectorXd amplitude;  ///< t, r: the variance with which the residuals agree
};

/// Evaluates how well the points that are left out are predicted where the values are measured with unit
/// noise: the mean over functions and points of -log N(e_ij; 0, 1 + variance_ij), without log(2 pi) / 2.
/// Errors far below 1 count nothing, whatever the size of a function. Buffers are kept; one thread each.
class LeftOutDensity {
 public:
  /// points: p x n; values: n x r. Both must outlive the object.
  LeftOutDensity(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, SharedStructure structure);

  /// The sum (nats) and its gradient with respect to log(length scales) and log(nugget); p + 1, resized.
  /// False if a matrix is not positive definite. Cost: some 3 n^3 + 6 n^2 (r + q) flops.
  bool evaluate(const SharedHyperparameters& hyperparameters, double& negative_log_density,
                Eigen::VectorXd& gradient);

  /// The same without the gradient; leaves getLeftOut(). Cost: n^3 flops.
  bool evaluate(const SharedHyperparameters& hyperparameters, double& negative_log_density);

  const LeftOut& getLeftOut() const { return left_out_; }

 private:
  bool calcPrecision(const SharedHyperparameters& hyperparameters);
  double calcDensity();
  void calcGradient(const SharedHyperparameters& hyperparameters, Eigen::VectorXd& gradient);

  const Eigen::MatrixXd& points_;
  const Eigen::MatrixXd& values_;
  SharedStructure structure_;
  Eigen::MatrixXd terms_;  // H', n x q
  Eigen::MatrixXd covariance_, slopes_, precision_, adjoint_;
  Eigen::MatrixXd weights_;  // P s, n x r
  LeftOut left_out_;
};

}  // namespace twinmap::gp
