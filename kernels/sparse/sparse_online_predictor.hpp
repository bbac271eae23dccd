#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "kernels/linalg/packed_lower.hpp"
#include "kernels/sparse/sparse_gaussian_process.hpp"

namespace twinmap::gp {

/// Predicts every target of sparse processes from one feature vector, as often and as fast as possible: no
/// allocation, no lock. The same formulas as SparseGaussianProcess::predict, agreeing with it to rounding.
class SparseOnlinePredictor {
 public:
  /// What is known of every target at a point.
  struct Values {
    Eigen::VectorXd mean;
    Eigen::VectorXd latent_variance;  ///< without noise
    Eigen::MatrixXd gradient;         ///< of the mean, d x targets
  };

  /// The buffers of one thread; make one per thread.
  class Workspace {
   public:
    explicit Workspace(const SparseOnlinePredictor& predictor);
    Values values;

   private:
    friend class SparseOnlinePredictor;
    Eigen::VectorXd point;       // x - c
    Eigen::VectorXd distances;   // q
    Eigen::VectorXd covariance;  // k, then L^-1 k, then L_B^-1 L^-1 k
    Eigen::VectorXd weight;      // -2 dk/dq
    Eigen::VectorXd error;       // e
  };

  /// One process per target; all with the same number of features (else, or if there are none or one is null,
  /// std::invalid_argument). Keeps its own packed copy: 8 m^2 + 16 m d bytes per target.
  explicit SparseOnlinePredictor(const std::vector<std::shared_ptr<const SparseGaussianProcess>>& processes);

  Eigen::Index getFeatureCount() const { return feature_count_; }
  Eigen::Index getTargetCount() const { return static_cast<Eigen::Index>(targets_.size()); }

  /// x: d features, finite (NaN in, NaN out); writes workspace.values.
  /// Cost per target: 2 m^2 + 5 m d flops and m exponentials.
  void predict(const Eigen::Ref<const Eigen::VectorXd>& x, Workspace& workspace) const;

 private:
  struct Target {
    ModelStructure structure;
    Hyperparameters hyperparameters;
    Eigen::VectorXd center, inverse_squared_scales;
    Eigen::MatrixXd points;  // Z - c, d x padded
    linalg::PackedSamples samples;
    linalg::PackedLower inducing_factor, correction_factor;
    Eigen::VectorXd weights;         // padded with zeros
    Eigen::MatrixXd whitened_basis;  // V_h / s_n, rows padded with zeros
    Eigen::MatrixXd basis_factor;    // R
    Eigen::VectorXd mean_coefficients;
    Eigen::Index size = 0;
  };

  static Target makeTarget(const SparseGaussianProcess& process);
  void predictTarget(Eigen::Index index, const Eigen::Ref<const Eigen::VectorXd>& x,
                     Workspace& workspace) const;
  static void addRadial(const Target& target, Eigen::Index index, Workspace& workspace);
  static void addMeanFunction(const Target& target, Eigen::Index index, Workspace& workspace);

  std::vector<Target> targets_;
  Eigen::Index feature_count_ = 0;
};

}  // namespace twinmap::gp
