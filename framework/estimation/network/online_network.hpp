#pragma once

#include <memory>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/network/network_map.hpp"
#include "kernels/linalg/paired_matrix.hpp"
#include "kernels/network/ensemble.hpp"

namespace twinmap {

/// A network made ready for one measurement after another. Estimates are those of the map, whose numbers
/// are rounded already, up to rounding of sums.
/// Immutable.
class OnlineNetwork {
 public:
  explicit OnlineNetwork(std::shared_ptr<const NetworkMap> map)
      : map_(std::move(map)), projection_(map_->inputs.projection), predictor_(map_->members) {}

  const NetworkMap& getMap() const { return *map_; }

  /// The buffers of one thread, and the result.
  class Workspace {
   public:
    explicit Workspace(const OnlineNetwork& map);
    Estimate estimate;

   private:
    friend class OnlineNetwork;
    network::EnsemblePredictor::Workspace predicting;
    Eigen::VectorXd centered;
  };

  /// features: d, finite; known: the inputs of the set-up (q). The result, whose inputs are the network's,
  /// lies in the workspace until its next use. Does not allocate but for mixtures and Bayesian networks.
  /// Cost: 2 flops a number of the map.
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known, Workspace& workspace) const;

  /// What the inferences' inputs are for features (d x n) and known inputs (q x n).
  Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const {
    return map_->inputs.apply(features, known);
  }

 private:
  void setMixture(const network::Predictor::Workspace& predicted, Estimate& estimate) const;

  std::shared_ptr<const NetworkMap> map_;
  linalg::PairedMatrix projection_;
  network::EnsemblePredictor predictor_;
};

}  // namespace twinmap
