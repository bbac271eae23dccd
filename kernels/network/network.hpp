#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace twinmap::network {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

/// y = weights x + biases.
struct Layer {
  MatrixXd weights;  ///< outputs x inputs
  VectorXd biases;   ///< outputs
};

/// Which products of inputs a regression takes: x_i x_j (i <= j) of the first `squared` inputs, then x_i x_j
/// x_k (i <= j <= k) of the first `cubed`, which are at most as many.
struct Products {
  Index squared = 0, cubed = 0;

  Index count() const { return squared * (squared + 1) / 2 + cubed * (cubed + 1) * (cubed + 2) / 6; }
  /// Sets `products` (count()) to those of `inputs` (k).
  void calculate(const Ref<const VectorXd>& inputs, Ref<VectorXd> products) const;
};

/// Outputs of a head that is one normal distribution of p targets: means, logarithms of the diagonal, lower
/// triangle.
inline Index countNormalOutputs(Index targets) {
  return 2 * targets + targets * (targets - 1) / 2;
}

/// Outputs of a head (density.hpp): those of one normal distribution, or of several and their weights.
inline Index countHeadOutputs(Index targets, Index components = 1) {
  return components == 1 ? countNormalOutputs(targets) : components * (countNormalOutputs(targets) + 1);
}

/// Components of a head of so many outputs.
inline Index countComponents(Index targets, Index outputs) {
  const Index one = countNormalOutputs(targets);
  return outputs == one ? 1 : outputs / (one + 1);
}

/// The first row of a component in a head.
inline Index getComponentRow(Index targets, Index components, Index component) {
  return components == 1 ? 0 : components + component * countNormalOutputs(targets);
}

/// A multilayer perceptron beside a regression: inputs x (k) to a normal distribution of targets y
/// (p), or a mixture of such. In units of what the regression leaves,
///   t = (y - offset - skip terms(x)) / scale,   terms(x): x and its products,
/// the hidden layers h -> SiLU(weights h + biases), SiLU(a) = a / (1 + exp(-a)), end in a linear one, the
/// head (density.hpp), which holds mean and precision of t, or those of each component. One column a sample.
/// Immutable once trained.
struct Network {
  VectorXd offset;            ///< p
  MatrixXd skip;              ///< p x terms
  VectorXd scale;             ///< p, standard deviations of what the regression leaves
  std::vector<Layer> layers;  ///< hidden ones, then the head
  Products products;

  Index countInputs() const { return layers.front().weights.cols(); }
  Index countTargets() const { return skip.rows(); }
  Index countComponents() const {
    return network::countComponents(countTargets(), layers.back().biases.size());
  }
};

/// Weights of layers with 21 significant bits (linalg::roundToHalves), which a Predictor reads in half of the
/// time: layers give the first digits of what the regression leaves, and that has all of its own.
Network roundWeights(Network network);

/// terms(x) of inputs (k x n), a column each.
MatrixXd makeTerms(const Ref<const MatrixXd>& inputs, const Products& products);

/// How a network begins.
struct NetworkShape {
  std::vector<int> hidden;  ///< units of each layer
  double ridge = 1e-8;      ///< of the regression
  Products products;
  Index components = 1;  ///< normal distributions of the head
};

/// A network that is still its regression, which training then adapts to the noise: hidden weights are normal
/// with the variance 1 / inputs, biases and head 0, so that t is standard normal; of several components the
/// biases of the means are standard normal numbers, as equal components would stay equal. The regression
/// minimises |targets - offset - skip terms|^2 + ridge n |skip|^2 over n samples, whose inputs (k x n) ought
/// to be of mean 0 and at most unit variance. normal(i): the i-th independent standard normal number. Cost: n
/// flops for each pair of terms.
Network makeNetwork(const MatrixXd& inputs, const MatrixXd& targets, const NetworkShape& shape,
                    const std::function<double(Index)>& normal);

/// Derivatives with respect to what is trained: the layers, and the regression in units of what it leaves,
/// skip_ij / scale_i.
struct Gradient {
  std::vector<Layer> layers;
  MatrixXd skip;
};

/// Of a network's shapes, zeros.
Gradient makeZeros(const Network& network);

}  // namespace twinmap::network
