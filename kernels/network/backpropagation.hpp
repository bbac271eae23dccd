#pragma once

#include "kernels/network/network.hpp"

namespace twinmap::network {

/// What a pass through a network leaves for the way back; one thread's, used again and again.
struct PassWorkspace {
  std::vector<MatrixXd> sums;     ///< before the activation, of each hidden layer
  std::vector<MatrixXd> gates;    ///< 1 / (1 + exp(-sum))
  std::vector<MatrixXd> outputs;  ///< after it
  MatrixXd head, targets, terms;
  MatrixXd back, next;
};

/// The loss (density.hpp) of a network's own targets y (p x n) for inputs (k x n), summed over the columns.
double calcLoss(const Network& network, const Ref<const MatrixXd>& inputs, const Ref<const MatrixXd>& targets,
                PassWorkspace& workspace);

/// The same, and its derivatives, which replace `gradient`'s (makeZeros()). Algebra of one thread, whose sums
/// are in an order that depends on the sizes alone. Cost: 6 n flops a weight.
double calcLossAndGradient(const Network& network, const Ref<const MatrixXd>& inputs,
                           const Ref<const MatrixXd>& targets, Gradient& gradient, PassWorkspace& workspace);

}  // namespace twinmap::network
