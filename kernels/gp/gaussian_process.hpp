#pragma once

#include <Eigen/Core>
#include <memory>

#include "kernels/gp/kernel_expansion.hpp"
#include "kernels/gp/model.hpp"

namespace twinmap::gp {

/// Everything a fitted process consists of; what a file has to hold to restore it exactly.
struct GaussianProcessParts {
  ModelStructure structure;
  Hyperparameters hyperparameters;
  std::shared_ptr<const Eigen::MatrixXd> inputs;  ///< X, d x n, shared by the targets
  Eigen::VectorXd alpha;                          ///< K^-1 (y - H'b), n
  Eigen::MatrixXd factor;                         ///< L, n x n, K + (s_n^2 + jitter) I = L L', zeros above
  Eigen::VectorXd mean_coefficients;              ///< b, p (0, 1 or 1 + d)
  double nlml = 0.0;                              ///< nats
  double jitter = 0.0;                            ///< squared target units
};

/// Predictions at m points, in the target's units.
struct Prediction {
  Eigen::VectorXd mean;
  Eigen::VectorXd latent_variance;  ///< of m(x) + f(x), without noise
  Eigen::VectorXd variance;         ///< of a new observation: latent_variance + s_n^2

  /// The standard deviation to report with an inferred parameter: that of the parameter given the features,
  /// sqrt(variance). The likelihood's noise belongs to it, since it stands for what the features cannot tell.
  Eigen::VectorXd stddev() const { return variance.cwiseSqrt(); }
};

/// A fitted Gaussian process; immutable. At a point x, with k = cov(f(X), f(x)) and v = L^-1 k (Rasmussen and
/// Williams eqs. 2.25, 2.26 and 2.42):
///   mean             k'alpha + h(x)'b
///   latent variance  k(x, x) - v'v + e'A^-1 e,   e = h(x) - V'v,   V = L^-1 H',   A = V'V.
/// The variance comes from the triangular factor; with an explicit inverse of K it drowns in rounding.
class GaussianProcess {
 public:
  /// Throws std::invalid_argument if the parts do not fit each other or a number is not finite.
  explicit GaussianProcess(GaussianProcessParts parts);

  const ModelStructure& getStructure() const { return parts_.structure; }
  const Hyperparameters& getHyperparameters() const { return parts_.hyperparameters; }
  const Eigen::MatrixXd& getInputs() const { return *parts_.inputs; }
  const Eigen::VectorXd& getAlpha() const { return parts_.alpha; }
  const Eigen::MatrixXd& getFactor() const { return parts_.factor; }
  const Eigen::VectorXd& getMeanCoefficients() const { return parts_.mean_coefficients; }
  double getNlml() const { return parts_.nlml; }
  const GaussianProcessParts& getParts() const { return parts_; }
  Eigen::Index getFeatureCount() const { return parts_.inputs->rows(); }
  Eigen::Index getSampleCount() const { return parts_.inputs->cols(); }
  /// c, the mean training input.
  const Eigen::VectorXd& getCenter() const { return expansion_.getCenter(); }
  /// 1 / l of each feature.
  const Eigen::VectorXd& getInverseLengthScales() const { return expansion_.getInverseLengthScales(); }
  /// V = L^-1 H', n x p, and the lower Cholesky factor R of A = V'V.
  const Eigen::MatrixXd& getWhitenedBasis() const { return whitened_basis_; }
  const Eigen::MatrixXd& getBasisFactor() const { return basis_factor_; }

  /// inputs: d x m, finite (else std::invalid_argument). Cost: m n (n + 2 d) flops.
  Prediction predict(const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;

  /// The mean as a function of the input: the same bits as predict()'s at a fraction of its cost.
  const KernelExpansion& getMean() const { return expansion_; }

 private:
  void predictBlock(const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index first,
                    Prediction& prediction) const;

  GaussianProcessParts parts_;
  KernelExpansion expansion_;
  Eigen::MatrixXd whitened_basis_;
  Eigen::MatrixXd basis_factor_;
};

}  // namespace twinmap::gp
