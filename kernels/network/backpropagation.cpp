#include "kernels/network/backpropagation.hpp"

#include "kernels/network/density.hpp"

namespace twinmap::network {
namespace {

const Ref<const MatrixXd> getLayerInputs(std::size_t layer, const Ref<const MatrixXd>& inputs,
                                         const PassWorkspace& workspace) {
  return layer == 0 ? inputs : Ref<const MatrixXd>(workspace.outputs[layer - 1]);
}

/// Sets sums, gates, outputs and head.
void passForward(const std::vector<Layer>& layers, const Ref<const MatrixXd>& inputs,
                 PassWorkspace& workspace) {
  const std::size_t hidden = layers.size() - 1;
  workspace.sums.resize(hidden);
  workspace.gates.resize(hidden);
  workspace.outputs.resize(hidden);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    MatrixXd& sums = i < hidden ? workspace.sums[i] : workspace.head;
    sums.noalias() = layers[i].weights * getLayerInputs(i, inputs, workspace);
    sums.colwise() += layers[i].biases;
    if (i < hidden) {
      workspace.gates[i] = (1.0 + (-sums.array()).exp()).inverse();
      workspace.outputs[i] = sums.array() * workspace.gates[i].array();
    }
  }
}

void setTargets(const Network& network, const Ref<const MatrixXd>& inputs, const Ref<const MatrixXd>& targets,
                PassWorkspace& workspace) {
  workspace.terms = makeTerms(inputs, network.products);
  workspace.targets = targets.colwise() - network.offset;
  workspace.targets.noalias() -= network.skip * workspace.terms;
  workspace.targets.array().colwise() /= network.scale.array();
}

/// `back`: derivatives with respect to the outputs of a hidden layer; become those of its sums.
void passActivation(const MatrixXd& gates, const MatrixXd& outputs, MatrixXd& back) {
  // d SiLU(a) / da = g + SiLU(a) (1 - g)
  back.array() *= gates.array() + outputs.array() * (1.0 - gates.array());
}

}  // namespace

double calcLoss(const Network& network, const Ref<const MatrixXd>& inputs, const Ref<const MatrixXd>& targets,
                PassWorkspace& workspace) {
  passForward(network.layers, inputs, workspace);
  setTargets(network, inputs, targets, workspace);
  return calcLoss(workspace.head, workspace.targets);
}

double calcLossAndGradient(const Network& network, const Ref<const MatrixXd>& inputs,
                           const Ref<const MatrixXd>& targets, Gradient& gradient, PassWorkspace& workspace) {
  passForward(network.layers, inputs, workspace);
  setTargets(network, inputs, targets, workspace);
  workspace.back.resize(workspace.head.rows(), workspace.head.cols());
  const double loss = calcLoss(workspace.head, workspace.targets, workspace.back);
  // the regression adds to the means
  gradient.skip.noalias() = sumMeanRows(workspace.back, targets.rows()) * workspace.terms.transpose();
  for (std::size_t i = network.layers.size(); i-- > 0;) {
    gradient.layers[i].weights.noalias() = workspace.back * getLayerInputs(i, inputs, workspace).transpose();
    gradient.layers[i].biases = workspace.back.rowwise().sum();
    if (i > 0) {
      workspace.next.noalias() = network.layers[i].weights.transpose() * workspace.back;
      workspace.back.swap(workspace.next);
      passActivation(workspace.gates[i - 1], workspace.outputs[i - 1], workspace.back);
    }
  }
  return loss;
}

}  // namespace twinmap::network
