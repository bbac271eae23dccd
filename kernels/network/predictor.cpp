#include "kernels/network/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/network/density.hpp"

namespace twinmap::network {
namespace {

void scaleCovariance(const VectorXd& scale, MatrixXd& covariance) {
  for (Index j = 0; j < scale.size(); ++j) {
    for (Index i = 0; i < scale.size(); ++i) {
      covariance(i, j) *= scale[i] * scale[j];
    }
  }
}

/// From the head's units to the targets'; the workspace's mean is still that of the regression alone.
void scaleComponents(const VectorXd& scale, Predictor::Workspace& workspace) {
  for (Index c = 0; c < workspace.weights.size(); ++c) {
    workspace.means.col(c) = workspace.mean + scale.cwiseProduct(workspace.means.col(c));
    scaleCovariance(scale, workspace.covariances[static_cast<std::size_t>(c)]);
  }
}

}  // namespace

Predictor::Predictor(Network network) : network_(std::move(network)) {
  const Layer& layer = network_.layers.front();
  const Index units = layer.weights.rows(), p = network_.countTargets();
  first_ = {MatrixXd(units + p, network_.countInputs()), VectorXd(units + p)};
  first_.weights << layer.weights, network_.skip.leftCols(network_.countInputs());
  first_.biases << layer.biases, network_.offset;
  of_products_ = network_.skip.rightCols(network_.products.count());
  head_ = network_.layers.back().weights;
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
  const Index components = network.countComponents();
  weights.resize(components);
  means.resize(p, components);
  covariances.assign(static_cast<std::size_t>(components), MatrixXd(p, p));
}

/// Moments of the components, and of their mixture, in the head's units.
void Predictor::mix(const Ref<const VectorXd>& head, Workspace& workspace) const {
  const Index p = network_.countTargets(), components = workspace.weights.size();
  calcWeights(head.head(components), workspace.weights);
  workspace.standard.setZero();
  for (Index c = 0; c < components; ++c) {
    calcMoments(head.segment(getComponentRow(p, components, c), countNormalOutputs(p)),
                workspace.means.col(c), workspace.covariances[static_cast<std::size_t>(c)],
                workspace.inverse);
    workspace.standard += workspace.weights[c] * workspace.means.col(c);
  }
  workspace.covariance.setZero();
  for (Index c = 0; c < components; ++c) {
    const auto apart = workspace.means.col(c) - workspace.standard;
    workspace.covariance += workspace.weights[c] * workspace.covariances[static_cast<std::size_t>(c)];
    workspace.covariance.noalias() += (workspace.weights[c] * apart).lazyProduct(apart.transpose());
  }
}

/// The next layer's sums in place of the last one's; the latter's activations are left in `other`.
template <class Weights>
void Predictor::propagate(const Weights& weights, const VectorXd& biases, Workspace& workspace) {
  auto sums = workspace.sums.head(weights.cols()).array();
  sums /= 1.0 + (-sums).exp();
  auto next = workspace.other.head(biases.size());
  next = biases;
  next.noalias() += weights * workspace.sums.head(weights.cols());
  workspace.sums.swap(workspace.other);
}

void Predictor::predict(const Ref<const VectorXd>& inputs, Workspace& workspace) const {
  const Index p = network_.countTargets();
  auto first = workspace.sums.head(first_.biases.size());
  first = first_.biases;
  first.noalias() += first_.weights * inputs;
  workspace.mean = first.tail(p);
  if (workspace.products.size() > 0) {
    network_.products.calculate(inputs, workspace.products);
    workspace.mean.noalias() += of_products_ * workspace.products;
  }
  for (std::size_t i = 1; i + 1 < network_.layers.size(); ++i) {
    propagate(network_.layers[i].weights, network_.layers[i].biases, workspace);
  }
  propagate(head_, network_.layers.back().biases, workspace);
  const auto head = workspace.sums.head(head_.rows());
  if (workspace.weights.size() == 1) {
    calcMoments(head, workspace.standard, workspace.covariance, workspace.inverse);
  } else {
    mix(head, workspace);
    scaleComponents(network_.scale, workspace);
  }
  workspace.mean += network_.scale.cwiseProduct(workspace.standard);
  scaleCovariance(network_.scale, workspace.covariance);
  workspace.stddev = workspace.covariance.diagonal().cwiseSqrt();
}

}  // namespace twinmap::network
