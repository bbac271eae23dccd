#include "kernels/network/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/network/density.hpp"

namespace twinmap::network {

Predictor::Predictor(Network network) : network_(std::move(network)) {
  const Layer& layer = network_.layers.front();
  const Index units = layer.weights.rows(), p = network_.countTargets();
  first_ = {MatrixXd(units + p, network_.countInputs()), VectorXd(units + p)};
  first_.weights << layer.weights, network_.skip.leftCols(network_.countInputs());
  first_.biases << layer.biases, network_.offset;
}

Predictor::Workspace::Workspace(const Predictor& predictor) {
  const Network& network = predictor.network_;
  const Index p = network.countTargets();
  Index widest = predictor.first_.biases.size();
  for (const Layer& layer : network.layers) {
    widest = std::max(widest, layer.biases.size());
  }
  sums.resize(widest);
  other.resize(widest);
  products.resize(network.products.count());
  standard.resize(p);
  mean.resize(p);
  stddev.resize(p);
  covariance.resize(p, p);
  inverse.resize(p, p);
}

void Predictor::predict(const Ref<const VectorXd>& inputs, Workspace& workspace) const {
  const Index p = network_.countTargets();
  Index units = network_.layers.front().biases.size();
  auto first = workspace.sums.head(units + p);
  first = first_.biases;
  first.noalias() += first_.weights * inputs;
  workspace.mean = first.tail(p);
  if (workspace.products.size() > 0) {
    network_.products.calculate(inputs, workspace.products);
    workspace.mean.noalias() += network_.skip.rightCols(workspace.products.size()) * workspace.products;
  }
  for (std::size_t i = 1; i < network_.layers.size(); ++i) {
    auto sums = workspace.sums.head(units).array();
    sums /= 1.0 + (-sums).exp();
    const Layer& layer = network_.layers[i];
    auto next = workspace.other.head(layer.biases.size());
    next = layer.biases;
    next.noalias() += layer.weights * workspace.sums.head(units);
    workspace.sums.swap(workspace.other);
    units = layer.biases.size();
  }
  calcMoments(workspace.sums.head(units), workspace.standard, workspace.covariance, workspace.inverse);
  workspace.mean += network_.scale.cwiseProduct(workspace.standard);
  for (Index i = 0; i < p; ++i) {
    for (Index j = 0; j < p; ++j) {
      workspace.covariance(i, j) *= network_.scale[i] * network_.scale[j];
    }
    workspace.stddev[i] = std::sqrt(workspace.covariance(i, i));
  }
}

}  // namespace twinmap::network
