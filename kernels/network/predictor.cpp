#include "kernels/network/predictor.hpp"

#include <algorithm>
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

Predictor::Predictor(Network network) : network_(std::move(network)), skip_(network_.skip) {
  for (const Layer& layer : network_.layers) {
    weights_.emplace_back(layer.weights);
  }
}

Predictor::Workspace::Workspace(const Predictor& predictor) {
  const Network& network = predictor.network_;
  const Index p = network.countTargets();
  Index widest = network.countInputs();
  for (const Layer& layer : network.layers) {
    widest = std::max(widest, layer.biases.size());
  }
  values.resize(widest);
  sums.resize(widest);
  terms.resize(network.skip.cols());
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

/// Leaves the head in the workspace's sums, and what the last hidden layer gave in its values.
void Predictor::propagate(const Ref<const VectorXd>& inputs, Workspace& workspace) const {
  workspace.values.head(inputs.size()) = inputs;
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    if (k > 0) {
      const auto sums = workspace.sums.head(weights_[k].cols()).array();
      workspace.values.head(sums.size()) = sums / (1.0 + (-sums).exp());
    }
    weights_[k].multiply(workspace.values.data(), workspace.sums.data());
    workspace.sums.head(weights_[k].rows()) += network_.layers[k].biases;
  }
}

void Predictor::predict(const Ref<const VectorXd>& inputs, Workspace& workspace) const {
  workspace.terms.head(inputs.size()) = inputs;
  network_.products.calculate(inputs, workspace.terms.tail(network_.products.count()));
  workspace.mean = network_.offset;
  workspace.mean.noalias() += skip_ * workspace.terms;
  propagate(inputs, workspace);
  const auto head = workspace.sums.head(network_.layers.back().biases.size());
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
