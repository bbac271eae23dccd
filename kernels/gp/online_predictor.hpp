#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/linalg/packed_lower.hpp"

namespace twinmap::gp {

/// Predicts every target from one feature vector, as often and as fast as possible: no allocation, no lock,
/// no branch on data. The same formulas as GaussianProcess::predict, agreeing with it to rounding; the
/// distances are computed once where the targets share inputs and a single length scale.
class OnlinePredictor {
 public:
  /// The buffers of one thread; make one per thread.
  class Workspace {
   public:
    explicit Workspace(const OnlinePredictor& predictor);

   private:
    friend class OnlinePredictor;
    Eigen::VectorXd point;       // x - c
    Eigen::VectorXd linear;      // s_l^2 (x - c)
    Eigen::MatrixXd distances;   // q, one column per target
    Eigen::VectorXd covariance;  // k, then v
    Eigen::VectorXd weight;
    Eigen::VectorXd error;  // e
  };

  /// One process per target, in the order of the results; all with the same number of features (else, or if
  /// there are none, std::invalid_argument). Keeps its own packed copy: 4 n^2 + 8 n d bytes per target.
  explicit OnlinePredictor(const std::vector<std::shared_ptr<const GaussianProcess>>& processes);
  explicit OnlinePredictor(const std::vector<GaussianProcess>& processes);

  Eigen::Index getFeatureCount() const { return feature_count_; }
  Eigen::Index getTargetCount() const { return static_cast<Eigen::Index>(targets_.size()); }

  /// x: d features, finite (NaN in, NaN out). Writes the mean and the stddev (noise included) of each target.
  /// The vectors must have getFeatureCount() and getTargetCount() entries: checked by assert only.
  /// Cost per target: n^2 + 3 n d flops and n exponentials.
  void predict(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> mean,
               Eigen::Ref<Eigen::VectorXd> stddev, Workspace& workspace) const;

 private:
  struct Target {
    ModelStructure structure;
    Hyperparameters hyperparameters;
    linalg::PackedLower factor;
    Eigen::VectorXd alpha;           // padded with zeros
    Eigen::MatrixXd whitened_basis;  // V, rows padded with zeros
    Eigen::MatrixXd basis_factor;    // R
    Eigen::VectorXd mean_coefficients;
    Eigen::Index sample_count = 0;
  };
  // Targets predicted from one pass over the inputs they share: up to kBatch of them.
  struct Batch {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::VectorXd center;  // c
    linalg::PackedSamples samples;
    Eigen::MatrixXd weights;  // 1 / l^2: kBatch or 1 rows, a column per feature
  };
  static constexpr Eigen::Index kBatch = 4;

  void build(const std::vector<const GaussianProcess*>& processes);
  static Target makeTarget(const GaussianProcess& process);
  static Batch makeBatch(const std::vector<const GaussianProcess*>& processes, Eigen::Index first,
                         Eigen::Index count);
  void predictTarget(Eigen::Index index, const Batch& batch, double& mean, double& stddev,
                     Workspace& workspace) const;
  static double applyMean(const Target& target, double variance, double& mean, Workspace& workspace);

  std::vector<Target> targets_;
  std::vector<Batch> batches_;
  Eigen::Index feature_count_ = 0;
};

}  // namespace twinmap::gp
