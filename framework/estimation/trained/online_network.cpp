#include "framework/estimation/trained/online_network.hpp"

namespace twinmap {

using Eigen::VectorXd;

OnlineNetwork::Workspace::Workspace(const OnlineNetwork& map)
    : predicting(map.predictor_), centered(map.map_->inputs.center.size()) {
  inference.method = EstimationMethod::kNetwork;
  inference.mean.resize(map.map_->center.size());
  inference.stddev.resize(map.map_->center.size());
  inference.inputs.resize(map.map_->inputs.countInputs());
  inference.correlation.resize(map.map_->center.size(), map.map_->center.size());
  inference.reach = map.map_->validation.reach;
}

void OnlineNetwork::setMixture(const network::Predictor::Workspace& predicted, Inference& inference) const {
  inference.mixture = takeMixture(predicted);
  convert(map_->center, map_->half_width, map_->validation.stddev_scale, inference.mixture);
  const Eigen::MatrixXd covariance = calcCovariance(inference.mixture);
  inference.stddev = covariance.diagonal().cwiseSqrt();
  inference.correlation = calcCorrelation(covariance);
  shrinkToBounds(map_->center, map_->half_width, inference.stddev, inference.mixture);
}

const Inference& OnlineNetwork::infer(const Eigen::Ref<const VectorXd>& features,
                                      const Eigen::Ref<const VectorXd>& known, Workspace& workspace) const {
  const NetworkInputs& inputs = map_->inputs;
  Inference& inference = workspace.inference;
  workspace.centered = features - inputs.center;
  projection_.multiply(workspace.centered.data(), inference.inputs.data());
  if (known.size() > 0) {
    inference.inputs.tail(known.size()) =
        (known - inputs.known.center).cwiseQuotient(inputs.known.half_width);
  }
  const network::Predictor::Workspace& answer = predictor_.predict(inference.inputs, workspace.predicting);
  inference.mean = map_->center + map_->half_width.cwiseProduct(answer.mean);
  inference.stddev =
      (map_->validation.stddev_scale.array() * map_->half_width.array()) * answer.stddev.array();
  const auto inverse_stddev = answer.stddev.cwiseInverse().asDiagonal();
  inference.correlation = inverse_stddev * answer.covariance * inverse_stddev;
  if (answer.weights.size() > 1) {
    setMixture(answer, inference);
  }
  shrinkToBounds(map_->center, map_->half_width, inference.mean, inference.stddev);
  return inference;
}

}  // namespace twinmap
