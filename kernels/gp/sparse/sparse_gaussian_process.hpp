#pragma once

#include <Eigen/Core>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/gp/kernel_expansion.hpp"
#include "kernels/gp/model.hpp"
#include "kernels/gp/sparse/variational_bound.hpp"

namespace twinmap::gp {

/// Everything a fitted sparse process consists of; what a file has to hold to restore it exactly.
struct SparseGaussianProcessParts {
  ModelStructure structure;
  Hyperparameters hyperparameters;
  Eigen::VectorXd center;    ///< c, the mean training input
  Eigen::MatrixXd inducing;  ///< Z, d x m
  VariationalPosterior posterior;
};

/// What predictions at k inputs are made of, a row each: the variance is missed_variance + |corrected|^2 +
/// |basis_error|^2.
struct SparseProjection {
  Eigen::VectorXd mean;
  Eigen::VectorXd missed_variance;  ///< k(x, x) - a'a: what the inducing inputs leave undetermined
  Eigen::MatrixXd corrected;        ///< (L_B^-1 a)', k x m
  Eigen::MatrixXd basis_error;      ///< (R^-1 e)', k x p
};

/// A Gaussian process summarised by m inducing inputs; immutable. With k = cov(f(Z), f(x)), a = L^-1 k:
///   mean             k'w + h(x)'b
///   latent variance  k(x, x) - a'a + |L_B^-1 a|^2 + |R^-1 e|^2,   e = h(x) - V_h' L_B^-1 a / s_n.
class SparseGaussianProcess {
 public:
  /// Throws std::invalid_argument if the parts do not fit each other or a number is not finite.
  explicit SparseGaussianProcess(SparseGaussianProcessParts parts);

  const SparseGaussianProcessParts& getParts() const { return parts_; }
  const Hyperparameters& getHyperparameters() const { return parts_.hyperparameters; }
  Eigen::Index getFeatureCount() const { return parts_.inducing.rows(); }
  Eigen::Index getInducingCount() const { return parts_.inducing.cols(); }

  /// inputs: d x k, finite (else std::invalid_argument). Cost: 2 k m (m + d) flops.
  Prediction predict(const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;

  /// The mean as a function of the input: the same bits as predict()'s. Cost: 2 k m d flops.
  const KernelExpansion& getMean() const { return expansion_; }

  /// inputs: d x k, finite, all of them at once: memory 2 k m. Cost as of predict.
  SparseProjection project(const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;

 private:
  SparseGaussianProcessParts parts_;
  KernelExpansion expansion_;
};

}  // namespace twinmap::gp
