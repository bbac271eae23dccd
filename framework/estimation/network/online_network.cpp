#include "framework/estimation/network/online_network.hpp"

#include "framework/estimation/network/network_file.hpp"

namespace twinmap {

using Eigen::VectorXd;

OnlineNetwork::Workspace::Workspace(const OnlineNetwork& map)
    : predicting(map.predictor_), centered(map.map_->inputs.center.size()) {
  estimate.estimator = map.getKind();
  estimate.mean.resize(map.map_->center.size());
  estimate.stddev.resize(map.map_->center.size());
  estimate.inputs.resize(map.map_->inputs.countInputs());
  estimate.correlation.resize(map.map_->center.size(), map.map_->center.size());
  estimate.interval_factors = map.map_->validation.interval_factors;
}

void OnlineNetwork::setMixture(const network::Predictor::Workspace& predicted, Estimate& estimate) const {
  estimate.mixture = takeMixture(predicted);
  convert(map_->center, map_->half_width, map_->validation.stddev_scale, estimate.mixture);
  const Eigen::MatrixXd covariance = calcCovariance(estimate.mixture);
  estimate.stddev = covariance.diagonal().cwiseSqrt();
  estimate.correlation = calcCorrelation(covariance);
  shrinkToBounds(map_->center, map_->half_width, estimate.stddev, estimate.mixture);
}

const Estimate& OnlineNetwork::infer(const Eigen::Ref<const VectorXd>& features,
                                     const Eigen::Ref<const VectorXd>& known,
                                     Estimator::Workspace& buffers) const {
  auto& workspace = static_cast<Workspace&>(buffers);
  const NetworkInputs& inputs = map_->inputs;
  Estimate& estimate = workspace.estimate;
  workspace.centered = features - inputs.center;
  projection_.multiply(workspace.centered.data(), estimate.inputs.data());
  if (known.size() > 0) {
    estimate.inputs.tail(known.size()) = (known - inputs.known.center).cwiseQuotient(inputs.known.half_width);
  }
  const network::Predictor::Workspace& predicted = predictor_.predict(estimate.inputs, workspace.predicting);
  estimate.mean = map_->center + map_->half_width.cwiseProduct(predicted.mean);
  estimate.stddev =
      (map_->validation.stddev_scale.array() * map_->half_width.array()) * predicted.stddev.array();
  const auto inverse_stddev = predicted.stddev.cwiseInverse().asDiagonal();
  estimate.correlation = inverse_stddev * predicted.covariance * inverse_stddev;
  if (predicted.weights.size() > 1) {
    setMixture(predicted, estimate);
  }
  shrinkToBounds(map_->center, map_->half_width, estimate.mean, estimate.stddev);
  return estimate;
}

void OnlineNetwork::save(Hdf5Writer& file, const std::string& group) const {
  writeNetworkMap(file, group, *map_);
}

std::shared_ptr<const Estimator> loadNetwork(const Hdf5Reader& file, const std::string& group) {
  return std::make_shared<const OnlineNetwork>(
      std::make_shared<const NetworkMap>(readNetworkMap(file, group)));
}

}  // namespace twinmap
