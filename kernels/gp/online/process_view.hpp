#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/gp/sparse/sparse_gaussian_process.hpp"

namespace twinmap::gp {

/// A trained process: exact, or sparse on inducing inputs.
using Process =
    std::variant<std::shared_ptr<const GaussianProcess>, std::shared_ptr<const SparseGaussianProcess>>;

/// The negative log marginal likelihood of a process, or the variational bound on it from above; nats.
double getNlml(const Process& process);

/// The variance of a process' noise, in squared target units.
double getNoiseVariance(const Process& process);

/// Both kinds of processes as predictions see them. It refers to the process, which must outlive it.
struct ProcessView {
  const ModelStructure& structure;
  const Hyperparameters& hyperparameters;
  const KernelExpansion& mean;
  const Eigen::MatrixXd& inputs;  ///< training samples or inducing inputs, d x n
  const Eigen::VectorXd& weights;
  const Eigen::MatrixXd& factor;        ///< L of the covariance of the inputs
  const Eigen::MatrixXd* correction;    ///< L_B of a sparse process, or null
  Eigen::MatrixXd whitened_basis;       ///< V, n x p
  const Eigen::MatrixXd& basis_factor;  ///< R, p x p
  const Eigen::VectorXd& mean_coefficients;

  /// Whether the distances to the inputs serve both.
  bool sharesInputs(const ProcessView& other) const;

  /// d, of the linear term and the mean function: the part of the mean's gradient that is the same
  /// everywhere.
  Eigen::VectorXd calcConstantGradient() const;
};

/// The process must not be null.
ProcessView viewProcess(const Process& process);

}  // namespace twinmap::gp
