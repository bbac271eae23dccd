#pragma once

#include <Eigen/Core>

#include "kernels/gp/marginal_likelihood.hpp"
#include "kernels/gp/model.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

/// What the variational approximation keeps of the data: the posterior's parts, all of order m.
struct VariationalPosterior {
  Eigen::MatrixXd inducing_factor;    ///< L, lower, K_uu + jitter = L L'
  Eigen::MatrixXd correction_factor;  ///< L_B, lower, B = I + A A' / s_n^2 = L_B L_B'
  Eigen::VectorXd weights;            ///< w, so that the mean is k_u(x)'w + h(x)'b
  Eigen::MatrixXd whitened_basis;     ///< V_h = L_B^-1 A H' / s_n, m x p
  Eigen::MatrixXd basis_factor;       ///< R, lower, H P^-1 H' = R R'
  Eigen::VectorXd mean_coefficients;  ///< b
  double bound = 0.0;                 ///< F, nats: at least the NLML
  double jitter = 0.0;                ///< added to K_uu's diagonal, squared target units
};

/// Titsias' bound on the negative log marginal likelihood (Variational learning of inducing variables in
/// sparse Gaussian processes, AISTATS 2009), with the mean integrated out: with A = L^-1 K_uf, Q = A'A and P
/// = Q + s_n^2 I,
///   F = 1/2 (y - H'b)'P^-1 (y - H'b) + 1/2 log|P| + 1/2 log|H P^-1 H'| + (n - p)/2 log(2 pi)
///       + (n s_f^2 - tr Q) / (2 s_n^2).
/// All by Woodbury's identity in blocks of samples: memory O(m^2 + m d) beyond the data.
class VariationalBound {
 public:
  /// inputs: d x n, inducing: d x m; the references must outlive the object. Throws std::invalid_argument for
  /// a linear covariance term, which the bound does not cover.
  VariationalBound(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& target,
                   const Eigen::MatrixXd& inducing, const ModelStructure& structure);

  /// False if K_uu or B is not positive definite. Cost: 2 n m^2 flops.
  bool calcPosterior(const Hyperparameters& hyperparameters, VariationalPosterior& posterior) const;

  /// F and its gradient in the log-hyperparameters (to_log's order), the inducing inputs fixed. The shape of
  /// a rational quadratic is held. Cost: 5 n m^2 flops.
  LikelihoodEvaluation evaluate(const Hyperparameters& hyperparameters, Eigen::VectorXd& gradient) const;

 private:
  struct Sums;
  struct Gradients;
  Sums accumulate(const Hyperparameters& hyperparameters, const Eigen::MatrixXd& inducing_factor) const;
  Eigen::MatrixXd scaledBlock(const Hyperparameters& hyperparameters, Eigen::Index first) const;
  Eigen::MatrixXd scaledInducing(const Hyperparameters& hyperparameters) const;
  Eigen::MatrixXd rightHandSides(Eigen::Index first) const;
  bool factorizeInducing(const Hyperparameters& hyperparameters, VariationalPosterior& posterior) const;
  bool factorizeCorrection(double noise_stddev, Sums& sums, VariationalPosterior& posterior) const;
  static double fitMean(const Eigen::MatrixXd& products, VariationalPosterior& posterior);
  double missedVariance(const Hyperparameters& hyperparameters, const Sums& sums) const;
  bool solve(const Hyperparameters& hyperparameters, VariationalPosterior& posterior, Sums& sums) const;
  void addSamples(const Hyperparameters& hyperparameters, const VariationalPosterior& posterior,
                  const Eigen::MatrixXd& scaled_inducing, Eigen::Index first,
                  linalg::TriangularScratch& scratch, Gradients& gradients) const;
  void addInducing(const Hyperparameters& hyperparameters, const Eigen::MatrixXd& aa,
                   const Eigen::MatrixXd& scaled_inducing, linalg::GemmScratch& scratch,
                   Gradients& gradients) const;

  const Eigen::MatrixXd& inputs_;
  const Eigen::VectorXd& target_;
  const Eigen::MatrixXd& inducing_;
  ModelStructure structure_;
  Eigen::VectorXd center_;
};

}  // namespace twinmap::gp
