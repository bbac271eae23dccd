#pragma once

#include <vector>

#include "kernels/network/last_layer.hpp"
#include "kernels/network/predictor.hpp"

namespace twinmap::network {

/// A network, and what its samples leave open of its last layer.
struct Member {
  Network network;
  /// Cholesky factor of the precision of the weights and biases of its means (LastLayerPosterior::lower), in
  /// units of what the regression leaves; empty where they are taken as known.
  MatrixXd last_layer;
};

/// A network whose last layer has its exact posterior given samples (inputs k x n, targets p x n), under the
/// prior precision of the highest evidence: its means become those of the posterior. Of a network of one
/// component. Cost: that of LastLayerEvidence.
Member makeBayesian(Network network, const Ref<const MatrixXd>& inputs, const Ref<const MatrixXd>& targets);

/// Networks made ready for one measurement after another: the mean and covariance of the mixture of their
/// answers, each as likely as the others. Immutable.
class EnsemblePredictor {
 public:
  explicit EnsemblePredictor(std::vector<Member> members);

  /// The buffers of one thread.
  struct Workspace {
    explicit Workspace(const EnsemblePredictor& predictor);

   private:
    friend class EnsemblePredictor;
    std::vector<Predictor::Workspace> members;
    Predictor::Workspace mixed;
  };

  /// The answer of all to inputs (k), left in the workspace until its next use: components of one network
  /// alone. Of one network without a posterior it does not allocate. Cost: that of each network, and (p h)^2
  /// p flops for each posterior.
  const Predictor::Workspace& predict(const Ref<const VectorXd>& inputs, Workspace& workspace) const;

 private:
  void addLastLayer(const MatrixXd& lower, const Network& network, Predictor::Workspace& answer) const;

  std::vector<Predictor> predictors_;
  std::vector<MatrixXd> last_layers_;
};

}  // namespace twinmap::network
