#pragma once

#include <Eigen/Core>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/gp/gp_map.hpp"
#include "kernels/gp/online/online_predictor.hpp"

namespace twinmap {

/// An inverse map made ready for one measurement after another: the transform's steps become one, the
/// processes are packed. Estimates are those of the map to rounding. Immutable.
class OnlineProcesses {
 public:
  explicit OnlineProcesses(GpMap map);

  const GpMap& getMap() const { return map_; }
  Eigen::Index getFeatureCount() const { return feature_count_; }

  /// The buffers of one thread, and the result.
  class Workspace {
   public:
    explicit Workspace(const OnlineProcesses& map);
    Estimate estimate;

   private:
    friend class OnlineProcesses;
    gp::OnlinePredictor::Workspace predictor;
    Eigen::VectorXd slope;
  };

  /// features: d, finite; known: the inputs of the set-up (q). The result lies in the workspace until its
  /// next use. It allocates nothing.
  /// Cost: 2 k d flops, then those of OnlinePredictor; some 10 us for four parameters.
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known, Workspace& workspace) const;
  /// Mean and inputs alone; the stddev is zero.
  const Estimate& inferMean(const Eigen::Ref<const Eigen::VectorXd>& features,
                            const Eigen::Ref<const Eigen::VectorXd>& known, Workspace& workspace) const;

 private:
  void makeInputs(const Eigen::Ref<const Eigen::VectorXd>& features,
                  const Eigen::Ref<const Eigen::VectorXd>& known, Eigen::VectorXd& inputs) const;
  double calcNoiseFactor(Eigen::Index parameter, const Eigen::Ref<const Eigen::VectorXd>& gradient,
                         Eigen::VectorXd& slope) const;

  GpMap map_;
  Eigen::Index feature_count_ = 0;
  Eigen::MatrixXd matrix_;  // inputs = matrix features + offset; one column: a factor for each feature
  Eigen::VectorXd offset_;
  Eigen::VectorXd noise_variance_;
  gp::OnlinePredictor predictor_;
};

/// The map with its exact processes compressed (gp::compress), where that makes them smaller: means within
/// some 0.01 standard deviations, standard deviations within 0.2 % of the exact ones.
GpMap compressMap(const GpMap& map);

}  // namespace twinmap
