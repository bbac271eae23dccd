#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/surrogate/shared_process.hpp"

namespace twinmap {

/// What features a parameter point gives, without the simulator, and with what error: features are projected
/// on scores of unit noise, whose clean values Gaussian processes learn from simulations, window by window.
/// A measured score at a point x is normal,
///   mean s(x),   covariance 1 + D(x) R D(x),
/// D the processes' standard deviations and R their errors' correlation. Points are normalised: -1 and 1 are
/// a parameter's bounds. Immutable.
struct ForwardSurrogate {
  Eigen::VectorXd center;                  ///< d, mean of the clean features
  Eigen::MatrixXd projection;              ///< r x d: scores = projection (features - center)
  Eigen::MatrixXd points;                  ///< m x n, of the training simulations
  Eigen::MatrixXd scores;                  ///< r x n, clean
  std::vector<gp::SharedProcess> windows;  ///< of consecutive scores
  Eigen::MatrixXd error_correlation;       ///< R, r x r
  Eigen::VectorXd error_variance;          ///< r, mean of that of points left out

  Eigen::Index getScoreCount() const { return projection.rows(); }
  /// Scores (r x n) of features (d x n), with the bits of kernels/exact. Cost: 2 r d n flops.
  Eigen::MatrixXd calcScores(const Eigen::MatrixXd& features) const;
  /// Values and standard deviations (r x b) of the processes at normalised points (m x b); the windows'
  /// standard deviations are multiplied by `widening`. One workspace a window.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& at, const std::vector<double>& widening,
                std::vector<gp::SharedProcess::Workspace>& workspaces, Eigen::MatrixXd& values,
                Eigen::MatrixXd& stddev) const;
};

}  // namespace twinmap
