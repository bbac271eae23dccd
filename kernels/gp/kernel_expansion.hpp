#pragma once

#include <Eigen/Core>

#include "kernels/gp/model.hpp"

namespace twinmap::gp {

/// The posterior mean of a process as a function of the input, expanded in the covariances with points z_j:
///   m(x) = sum_j w_j cov(f(z_j), f(x)) + h(x)'b.
/// Exact processes have a point per training sample, sparse ones per inducing input. Immutable.
class KernelExpansion {
 public:
  KernelExpansion() = default;
  /// points: d x n; center: d, the mean training input; weights: n; mean_coefficients: b. The caller has
  /// checked that they fit each other.
  KernelExpansion(const ModelStructure& structure, const Hyperparameters& hyperparameters,
                  const Eigen::VectorXd& center, const Eigen::MatrixXd& points,
                  const Eigen::VectorXd& weights, const Eigen::VectorXd& mean_coefficients);

  const Eigen::VectorXd& getCenter() const { return center_; }
  /// 1 / l of each feature.
  const Eigen::VectorXd& getInverseLengthScales() const { return inverse_length_scales_; }

  /// x - c of each column of `inputs` (d x m).
  Eigen::MatrixXd calcCentered(const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;
  /// cov(f(x_i), f(z_j)), m x n, of centred inputs (d x m). Cost: 2 m n d flops.
  Eigen::MatrixXd calcCovariance(const Eigen::MatrixXd& centered) const;
  /// cov(f(x), f(x)) of each column of centred inputs.
  Eigen::VectorXd calcPriorVariance(const Eigen::MatrixXd& centered) const;
  /// m(x) from calcCovariance().
  Eigen::VectorXd calcMean(const Eigen::MatrixXd& centered, const Eigen::MatrixXd& covariance) const;

  /// m(x) of each column of `inputs` (d x m), block by block. Cost: 2 m n d flops.
  Eigen::VectorXd predictMean(const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;
  /// dm / dx, d x m. Cost: 4 m n d flops.
  Eigen::MatrixXd predictMeanGradient(const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;

 private:
  Eigen::MatrixXd calcGradient(const Eigen::MatrixXd& centered) const;

  ModelStructure structure_;
  Hyperparameters hyperparameters_;
  Eigen::VectorXd center_;
  Eigen::VectorXd inverse_length_scales_;
  Eigen::MatrixXd scaled_points_;  // (Z - c) / l, d x n
  Eigen::VectorXd weights_;
  Eigen::VectorXd mean_coefficients_;
};

}  // namespace twinmap::gp
