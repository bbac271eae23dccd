#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "kernels/gp/online/process_view.hpp"
#include "kernels/linalg/packed_lower.hpp"

namespace twinmap::gp {

/// Predicts every target from one feature vector, as often and as fast as possible: no allocation, no lock,
/// no branch on data. The same formulas as GaussianProcess::predict and SparseGaussianProcess::predict,
/// agreeing with them to rounding; targets that share their inputs share the pass over them.
class OnlinePredictor {
 public:
  /// What is known of every target at a point.
  struct Values {
    Eigen::VectorXd mean;
    Eigen::VectorXd latent_variance;  ///< without noise
    Eigen::VectorXd stddev;           ///< noise included
    Eigen::MatrixXd gradient;         ///< of the mean, d x targets; written by predictWithGradient alone
  };

  /// The buffers of one thread, and the result; make one per thread.
  class Workspace {
   public:
    explicit Workspace(const OnlinePredictor& predictor);
    Values values;

   private:
    friend class OnlinePredictor;
    Eigen::VectorXd point;       // x - c
    Eigen::VectorXd linear;      // s_l^2 (x - c)
    Eigen::MatrixXd distances;   // q, one column per target
    Eigen::VectorXd covariance;  // k, then L^-1 k, then L_B^-1 L^-1 k
    Eigen::VectorXd weight;      // -2 dk/dq
    Eigen::VectorXd error;       // e
  };

  /// One process per target, in the order of the results; all with the same number of features (else, or if
  /// there are none or one is null, std::invalid_argument). Keeps its own packed copy: 4 n^2 + 8 n d bytes
  /// per target of n samples, 8 m^2 + 8 m d of m inducing inputs.
  explicit OnlinePredictor(const std::vector<Process>& processes);

  Eigen::Index getFeatureCount() const { return feature_count_; }
  Eigen::Index getTargetCount() const { return static_cast<Eigen::Index>(targets_.size()); }

  /// x: getFeatureCount() entries (checked by assert only), finite (NaN in, NaN out); writes
  /// workspace.values.
  /// Cost per target: n^2 + 3 n d flops and n exponentials; of a sparse process 2 m^2 + 3 m d and m.
  void predict(const Eigen::Ref<const Eigen::VectorXd>& x, Workspace& workspace) const;
  /// The means alone, for 3 n d flops per target.
  void predictMean(const Eigen::Ref<const Eigen::VectorXd>& x, Workspace& workspace) const;
  /// The same as predict() and the gradient, for 2 n d flops more per target.
  void predictWithGradient(const Eigen::Ref<const Eigen::VectorXd>& x, Workspace& workspace) const;

 private:
  struct Target {
    ModelStructure structure;
    Hyperparameters hyperparameters;
    linalg::PackedLower factor;                     // L
    std::optional<linalg::PackedLower> correction;  // L_B of a sparse process
    Eigen::VectorXd weights;                        // alpha, padded with zeros
    Eigen::VectorXd constant_gradient;              // of the linear term and the mean function
    Eigen::MatrixXd whitened_basis;                 // V, rows padded with zeros
    Eigen::MatrixXd basis_factor;                   // R
    Eigen::VectorXd mean_coefficients;
    Eigen::Index input_count = 0;
  };
  // Targets predicted from one pass over the inputs they share: up to kBatch of them.
  struct Batch {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::VectorXd center;  // c
    linalg::PackedSamples inputs;
    Eigen::MatrixXd weights;  // 1 / l^2: kBatch or 1 rows, a column per feature
  };
  static constexpr Eigen::Index kBatch = 4;

  static Batch makeBatch(const std::vector<ProcessView>& sources, Eigen::Index first);
  static Target makeTarget(const ProcessView& source);

  enum class Extent { kMean, kVariance, kGradient };
  void predictAll(const Eigen::Ref<const Eigen::VectorXd>& x, Extent extent, Workspace& workspace) const;
  void calcDistances(const Batch& batch, Workspace& workspace) const;
  void calcMean(Eigen::Index index, const Batch& batch, Workspace& workspace) const;
  void calcVariance(Eigen::Index index, Workspace& workspace) const;
  static double calcMeanFunctionVariance(const Target& target, Workspace& workspace);
  void calcGradient(Eigen::Index index, const Batch& batch, Workspace& workspace) const;

  std::vector<Target> targets_;
  std::vector<Batch> batches_;
  Eigen::Index feature_count_ = 0;
};

}  // namespace twinmap::gp
