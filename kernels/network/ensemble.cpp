#include "kernels/network/ensemble.hpp"

#include <utility>

namespace twinmap::network {

Member makeBayesian(Network network, const Ref<const MatrixXd>& inputs, const Ref<const MatrixXd>& targets) {
  const LinearObservations observations = observeLastLayer(network, inputs, targets);
  LastLayerPosterior posterior =
      calcLastLayerPosterior(observations, LastLayerEvidence(observations).maximise());
  setMeanWeights(posterior.mean, network);
  return {std::move(network), std::move(posterior.lower)};
}

EnsemblePredictor::EnsemblePredictor(std::vector<Member> members) {
  for (Member& member : members) {
    predictors_.emplace_back(std::move(member.network));
    last_layers_.push_back(std::move(member.last_layer));
  }
}

EnsemblePredictor::Workspace::Workspace(const EnsemblePredictor& predictor)
    : members(predictor.predictors_.begin(), predictor.predictors_.end()),
      mixed(predictor.predictors_.front()) {}

void EnsemblePredictor::addLastLayer(const MatrixXd& lower, const Network& network,
                                     Predictor::Workspace& answer) const {
  const Index units = network.layers.back().weights.cols();
  VectorXd inputs(units + 1);
  inputs << answer.getHidden(units), 1.0;
  const LastLayerPosterior posterior{getMeanWeights(network), lower};
  answer.covariance +=
      network.scale.asDiagonal() * posterior.calcCovariance(inputs) * network.scale.asDiagonal();
  answer.stddev = answer.covariance.diagonal().cwiseSqrt();
}

const Predictor::Workspace& EnsemblePredictor::predict(const Ref<const VectorXd>& inputs,
                                                       Workspace& workspace) const {
  for (std::size_t i = 0; i < predictors_.size(); ++i) {
    predictors_[i].predict(inputs, workspace.members[i]);
    if (last_layers_[i].size() > 0) {
      addLastLayer(last_layers_[i], predictors_[i].getNetwork(), workspace.members[i]);
    }
  }
  if (predictors_.size() == 1) {
    return workspace.members.front();
  }
  Predictor::Workspace& mixed = workspace.mixed;
  const double share = 1.0 / static_cast<double>(predictors_.size());
  mixed.mean.setZero();
  mixed.covariance.setZero();
  for (const Predictor::Workspace& one : workspace.members) {
    mixed.mean += share * one.mean;
    mixed.covariance += share * one.covariance;
  }
  for (const Predictor::Workspace& one : workspace.members) {
    const VectorXd apart = one.mean - mixed.mean;
    mixed.covariance += share * apart * apart.transpose();
  }
  mixed.stddev = mixed.covariance.diagonal().cwiseSqrt();
  return mixed;
}

}  // namespace twinmap::network
