#pragma once

#include "kernels/network/backpropagation.hpp"
#include "kernels/network/network.hpp"

namespace twinmap::network {

/// The posterior density of all weights of a network given samples, as a function of the vector z of the
/// weights over the standard deviations of their prior: its logarithm is
///   -sum_i loss_i(z) - z' z / 2
/// but for a summand. The prior is normal, of weights and biases with the mean 0 and the standard deviations
/// 2 / sqrt(inputs), twice that with which networks begin, and 2: wide enough to leave the shape to the
/// samples; of skip / scale about that of `reference`, with 2 / sqrt(terms).
class WeightDensity {
 public:
  /// inputs: k x n, targets: p x n.
  WeightDensity(Network reference, MatrixXd inputs, MatrixXd targets);

  Index countWeights() const;

  /// z of a network of the same shape; its regression's offset and scale are those of `reference`.
  VectorXd pack(const Network& network) const;
  Network unpack(const Ref<const VectorXd>& z) const;

  /// The logarithm but for a summand; sets its gradient. Not from several threads at once. Cost: 6 n flops a
  /// weight.
  double calculate(const VectorXd& z, VectorXd& gradient);

 private:
  Network reference_;
  MatrixXd inputs_, targets_;
  Gradient gradient_;
  PassWorkspace pass_;
};

}  // namespace twinmap::network
