#pragma once

#include <Eigen/Core>

#include "kernels/surrogate/slope_covariance.hpp"

namespace twinmap::gp {

/// Sums of one function's weights of slopes, w_iv of the first m points and u variables, at a point; D are
/// PointCovariance's differences, s its slopes. They are what evaluating a process costs, and the weights fit
/// no fast cache: four variables at a time are kept in registers, and the weights read once.
struct SlopeSums {
  Eigen::ArrayXd projected;  ///< sum_v D_iv w_iv, m
  Eigen::ArrayXd weighted;   ///< sum_i s_i w_iv, u

  /// weights: m x u. Cost: 4 m u flops.
  void calc(const PointCovariance& at, const Eigen::Ref<const Eigen::MatrixXd>& weights);
};

/// sum_i D_iv f_i of the first variables, as many as `sums` has; f: n. Cost: 2 n flops a variable.
void sumDifferences(const PointCovariance& at, const Eigen::ArrayXd& f, Eigen::Ref<Eigen::VectorXd> sums);

}  // namespace twinmap::gp
