#include "kernels/network/network.hpp"

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/paired_matrix.hpp"

namespace twinmap::network {
namespace {

void fitRegression(const MatrixXd& inputs, const MatrixXd& targets, double ridge, Network& network) {
  const auto n = static_cast<double>(inputs.cols());
  const MatrixXd terms = makeTerms(inputs, network.products);
  const VectorXd center = terms.rowwise().mean();
  const VectorXd mean = targets.rowwise().mean();
  const MatrixXd centered = terms.colwise() - center;
  MatrixXd squares = centered * centered.transpose() / n;
  squares.diagonal().array() += ridge;
  const MatrixXd cross = centered * (targets.colwise() - mean).transpose() / n;
  network.skip = linalg::solveCholesky(linalg::calcCholesky(squares).lower, cross).transpose();
  network.offset = mean - network.skip * center;
  const MatrixXd rest = (targets - network.skip * terms).colwise() - network.offset;
  // a target that the regression gives exactly still needs a unit
  constexpr double kSmallest = 1e-6;
  network.scale = (rest.rowwise().squaredNorm() / n).cwiseSqrt().cwiseMax(kSmallest);
}

}  // namespace

void Products::calculate(const Ref<const VectorXd>& inputs, Ref<VectorXd> products) const {
  Index first = 0;
  for (Index j = 0; j < squared; ++j) {
    products.segment(first, j + 1) = inputs[j] * inputs.head(j + 1);
    first += j + 1;
  }
  for (Index k = 0; k < cubed; ++k) {
    const Index pairs = (k + 1) * (k + 2) / 2;  // those of the first k + 1 inputs come first
    products.segment(first, pairs) = inputs[k] * products.head(pairs);
    first += pairs;
  }
}

MatrixXd makeTerms(const Ref<const MatrixXd>& inputs, const Products& products) {
  const Index k = inputs.rows(), count = products.count();
  MatrixXd terms(k + count, inputs.cols());
  terms.topRows(k) = inputs;
  for (Index i = 0; i < inputs.cols() && count > 0; ++i) {
    products.calculate(inputs.col(i), terms.col(i).tail(count));
  }
  return terms;
}

Network makeNetwork(const MatrixXd& inputs, const MatrixXd& targets, const NetworkShape& shape,
                    const std::function<double(Index)>& normal) {
  Network network;
  network.products = shape.products;
  fitRegression(inputs, targets, shape.ridge, network);
  Index before = inputs.rows(), drawn = 0;
  for (const int units : shape.hidden) {
    const double stddev = 1.0 / std::sqrt(static_cast<double>(before));
    MatrixXd weights(units, before);
    for (Index i = 0; i < weights.size(); ++i) {
      weights.data()[i] = stddev * normal(drawn++);
    }
    network.layers.push_back({std::move(weights), VectorXd::Zero(units)});
    before = units;
  }
  const Index p = targets.rows(), outputs = countHeadOutputs(p, shape.components);
  network.layers.push_back({MatrixXd::Zero(outputs, before), VectorXd::Zero(outputs)});
  for (Index c = 0; c < shape.components && shape.components > 1; ++c) {
    for (Index i = 0; i < p; ++i) {
      network.layers.back().biases[getComponentRow(p, shape.components, c) + i] = normal(drawn++);
    }
  }
  return network;
}

Network roundWeights(Network network) {
  for (Layer& layer : network.layers) {
    layer.weights = linalg::roundToHalves(layer.weights);
  }
  return network;
}

Gradient makeZeros(const Network& network) {
  Gradient zeros{{}, MatrixXd::Zero(network.skip.rows(), network.skip.cols())};
  for (const Layer& layer : network.layers) {
    zeros.layers.push_back(
        {MatrixXd::Zero(layer.weights.rows(), layer.weights.cols()), VectorXd::Zero(layer.biases.size())});
  }
  return zeros;
}

}  // namespace twinmap::network
