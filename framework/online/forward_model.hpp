#pragma once

#include <Eigen/Core>

#include "kernels/interpolation/interpolator.hpp"

namespace twinmap {

/// What features a parameter point gives, without the simulator: the clean features of the training
/// simulations, whitened by their noise, as principal components whose scores are smooth functions of the
/// point, interpolated. Points are normalised: -1 and 1 are a parameter's bounds. Immutable.
struct ForwardModel {
  Eigen::MatrixXd whitener;    ///< W, k x d, W C W' = 1 for the noise covariance C; d x 1 if it is diagonal
  Eigen::VectorXd center;      ///< d, mean of the clean features
  Eigen::MatrixXd components;  ///< V, k x r, orthonormal
  Eigen::MatrixXd scores;      ///< r x n, of the training simulations, in noise standard deviations
  gp::Interpolator score_map;  ///< normalised point -> scores, with its error

  /// z = W (f - center) of features (d): in noise standard deviations.
  void whiten(const Eigen::Ref<const Eigen::VectorXd>& features, Eigen::VectorXd& whitened) const;
};

/// The point that explains a measurement best, and what it leaves unexplained.
struct Explanation {
  Eigen::VectorXd point;     ///< m, normalised
  Eigen::VectorXd residual;  ///< k, whitened features minus those of the point, in standard deviations
  double chi_square = 0.0;   ///< |residual|^2
};

/// The buffers of one thread.
struct ExplanationWorkspace {
  gp::Interpolator::Workspace forward;
  Eigen::VectorXd whitened, scores, misfit, step, trial, gradient;
  Eigen::MatrixXd jacobian, normal;
  Explanation best, other;
};

/// Fits the model to clean features (d x n) of simulations at normalised points (m x n). Components whose
/// standard deviation over the simulations is below 0.2 of the noise's are left out, and so are those beyond
/// n / 3 and 60. At most the first 1000 simulations are used. Throws std::invalid_argument for a feature
/// without noise and for too few simulations (n < m + 3).
ForwardModel fitForwardModel(const Eigen::MatrixXd& points, const Eigen::MatrixXd& clean_features,
                             const Eigen::MatrixXd& noise_covariance);

/// Searches the first `unknown` variables of the point, the others held, for the least
///   |W(f - c) - V s(point)|^2,
/// where an error of the interpolation counts as noise of the scores, by Levenberg and Marquardt's method
/// within 1.25 times the box: from `start`, and, if that explains too little, from the most similar training
/// simulation. The result, workspace.best, is valid until the next call.
/// Cost: some 5 to 10 evaluations of the interpolator.
const Explanation& explain(const ForwardModel& model, const Eigen::Ref<const Eigen::VectorXd>& features,
                           const Eigen::Ref<const Eigen::VectorXd>& start, Eigen::Index unknown,
                           ExplanationWorkspace& workspace);

}  // namespace twinmap
