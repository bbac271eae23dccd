#pragma once

#include <vector>

#include "kernels/network/network.hpp"

namespace twinmap::network {

/// Normal observations of linear outputs: t_i = W f_i + e_i, e_i of precision P_i.
struct LinearObservations {
  MatrixXd inputs;                   ///< f: h x n
  MatrixXd targets;                  ///< t: p x n
  std::vector<MatrixXd> precisions;  ///< P: n of p x p, positive definite
};

/// The exact posterior of the weights W (p x h) of linear outputs, whose prior is independent and normal with
/// the mean 0: normal, of the precision alpha 1 + sum_i (f_i f_i') x P_i over the columns of W below each
/// other.
struct LastLayerPosterior {
  MatrixXd mean;   ///< p x h
  MatrixXd lower;  ///< p h x p h, Cholesky factor of the precision

  /// The covariance (p x p) of W f. Cost: (p h)^2 p flops.
  MatrixXd calcCovariance(const Ref<const VectorXd>& inputs) const;
};

/// alpha > 0: the prior's precision. Cost: (p h)^2 n + (p h)^3 / 3 flops.
LastLayerPosterior calcLastLayerPosterior(const LinearObservations& observations, double alpha);

/// The logarithm of the density of all targets, the weights integrated out (the evidence), as a function of
/// the prior's precision alpha.
class LastLayerEvidence {
 public:
  /// Cost: (p h)^2 n + 9 (p h)^3 flops.
  explicit LastLayerEvidence(const LinearObservations& observations);

  /// Cost: p h flops.
  double calculate(double alpha) const;

  /// The alpha of the highest evidence within [1e-8, 1e8], to 1 %.
  double maximise() const;

 private:
  VectorXd eigenvalues_, projected_;  // of the observations' information; of their weighted sum, in its basis
  double constant_ = 0.0;
};

/// What samples (inputs k x n, targets p x n) tell of the weights and biases of a network's means: f is what
/// the last hidden layer gives, and 1; the precision P is the one that the network states. Of a network of
/// one component.
LinearObservations observeLastLayer(const Network& network, const Ref<const MatrixXd>& inputs,
                                    const Ref<const MatrixXd>& targets);

/// The weights and biases of a network's means: p x h + 1.
MatrixXd getMeanWeights(const Network& network);
void setMeanWeights(const MatrixXd& weights, Network& network);

}  // namespace twinmap::network
