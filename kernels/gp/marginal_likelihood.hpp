#pragma once

#include <Eigen/Core>

#include "kernels/gp/model.hpp"
#include "kernels/gp/training_set.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

/// Threads that share one evaluation: all above n = 1500 (2 n^2 doubles, 36 MB a thread, would be too much
/// for each), below it one.
int getTeamSize(const TrainingSet& set, int threads);

/// Buffers of one evaluation at a time: 2 n^2 doubles (3 n^2 for the rational quadratic) and some n^2 / 2 of
/// scratch. After construction, evaluations with it allocate nothing.
struct LikelihoodWorkspace {
  /// threads: the team that shares one evaluation's algebra; it pays from n = 1500 or so on, and changes no
  /// bit of the result.
  explicit LikelihoodWorkspace(const TrainingSet& set, int threads = 1);

  Eigen::MatrixXd factor;            ///< q, then K, then L, then K^-1, then W; padded(n) x n, lower
  Eigen::MatrixXd weights;           ///< dK_ij / dq_ij up to -2, then T = W .* weights; strictly lower
  Eigen::MatrixXd shape_derivative;  ///< dK / dlog a; empty without a shape
  Eigen::MatrixXd corrections;       ///< [alpha, U], n x (1 + p), so that W = K^-1 - corrections corrections'
  Eigen::MatrixXd whitened_basis;    ///< L^-1 H', n x p
  Eigen::MatrixXd basis_factor;      ///< lower Cholesky factor of A = H K^-1 H', p x p
  Eigen::VectorXd mean_coefficients;  ///< b, p
  Eigen::MatrixXd squared_distance;   ///< one column of q for each thread
  Eigen::VectorXd group_sums;
  SquaredDistances::Workspace distances;
  linalg::TriangularScratch scratch;
};

struct LikelihoodEvaluation {
  bool ok = false;      ///< false: no positive definite matrix within the largest jitter; nlml is +infinity
  double nlml = 0.0;    ///< nats
  double jitter = 0.0;  ///< variance added to the diagonal beyond the noise's, in squared target units
};

/// The negative log marginal likelihood of one target y (length n) with the mean integrated out (Rasmussen
/// and Williams eq. 2.45), K = cov f + s_n^2 I = L L':
///   NLML = 1/2 (y - H'b)' K^-1 (y - H'b) + log|L| + 1/2 log|A| + (n - p)/2 log(2 pi),
///   A = H K^-1 H',   b = A^-1 H K^-1 y,   alpha = K^-1 (y - H'b).
/// Leaves L, alpha, b and A's factor in the workspace. Where K is not positive definite to rounding, jitter
/// is added from 1e-14 of the diagonal on, tenfold at a time up to 1e-6. Cost: n^3 / 3 + O(n^2 (p + G)) flops
/// and n^2 / 2 exponentials.
LikelihoodEvaluation evaluateLikelihood(const TrainingSet& set, const Eigen::VectorXd& target,
                                        const Hyperparameters& hyperparameters,
                                        LikelihoodWorkspace& workspace);

/// The same with the gradient in the log-hyperparameters, in to_log's order (eq. 5.9 with
/// W = K^-1 - U U' - alpha alpha', U U' the mean's correction): dNLML/dt = 1/2 tr(W dK/dt). The signal's and
/// the noise's derivatives need only tr(W), because tr(W K) = n - p - alpha'y. W replaces L in the workspace.
/// `gradient` must have the layout's size; it is zero if the evaluation is not ok. Cost: n^3 flops.
LikelihoodEvaluation evaluateLikelihoodGradient(const TrainingSet& set, const Eigen::VectorXd& target,
                                                const Hyperparameters& hyperparameters,
                                                LikelihoodWorkspace& workspace, Eigen::VectorXd& gradient);

}  // namespace twinmap::gp
