#include "framework/estimation/network/online_network.hpp"

#include <string>

#include "framework/base/hdf5/hdf5_fields.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/surrogate/surrogate_file.hpp"

namespace twinmap {

using Eigen::VectorXd;
namespace {

using Eigen::Index;

template <class Fields, class Member>
void listMember(const Fields& fields, Member& member) {
  auto& network = member.network;
  fields("regression/offset", network.offset);
  fields.transposed("regression/weights", network.skip);
  fields("regression/scale", network.scale);
  fields("regression/squared", network.products.squared);
  fields("regression/cubed", network.products.cubed);
  fields.each("layers/count", "layers", network.layers, [](const Fields& of_layer, auto& layer) {
    of_layer.transposed("weights", layer.weights);
    of_layer("biases", layer.biases);
  });
  if (fields.has("last_layer", member.last_layer.size() > 0)) {
    fields("last_layer", member.last_layer);
  }
}

template <class Fields, class Map>
void listMap(const Fields& fields, Map& map) {
  fields("inputs/center", map.inputs.center);
  fields.transposed("inputs/projection", map.inputs.projection);
  fields("inputs/known_center", map.inputs.known.center);
  fields("inputs/known_half_width", map.inputs.known.half_width);
  fields("center", map.center);
  fields("half_width", map.half_width);
  fields.each("members/count", "members", map.members,
              [](const Fields& of_member, auto& member) { listMember(of_member, member); });
}

/// Whether a network of k inputs and p targets has layers of sizes that follow each other.
bool fitsTogether(const network::Member& member, Index k, Index p) {
  const network::Network& network = member.network;
  bool fits = !network.layers.empty() && network.products.squared <= k && network.products.cubed <= k;
  Index width = k;
  for (const network::Layer& layer : network.layers) {
    fits = fits && layer.weights.cols() == width && layer.biases.size() == layer.weights.rows();
    width = layer.weights.rows();
  }
  if (!fits || network.offset.size() != p || network.scale.size() != p || network.skip.rows() != p ||
      network.skip.cols() != k + network.products.count()) {
    return false;
  }
  const Index components = network.countComponents();
  const Index determined = p * (network.layers.back().weights.cols() + 1);
  return components >= 1 && width == network::countHeadOutputs(p, components) &&
         (member.last_layer.size() == 0 || (components == 1 && member.last_layer.rows() == determined &&
                                            member.last_layer.cols() == determined));
}

bool fitsTogether(const NetworkMap& map) {
  const Index p = map.center.size(), d = map.inputs.center.size();
  bool fits = p > 0 && map.half_width.size() == p && !map.members.empty() &&
              map.inputs.projection.cols() == d &&
              map.inputs.known.half_width.size() == map.inputs.known.center.size() &&
              fitsParameters(map.validation, p);
  for (const network::Member& member : map.members) {
    fits = fits && fitsTogether(member, map.inputs.countInputs(), p) &&
           member.network.countComponents() == map.members.front().network.countComponents();
  }
  return fits && (map.members.size() == 1 || map.countComponents() == 1);
}

/// Writes inputs, bounds, weights and validation of a network below `group` (docs/reference/files.md).
void writeNetworkMap(Hdf5Writer& file, const std::string& group, const NetworkMap& map) {
  listMap(WrittenFields(file, group), map);
  writeValidation(file, group + "/validation", map.validation);
}

/// Reads it back; it predicts bit for bit as the one that was written. Throws std::runtime_error for parts
/// that are missing or do not fit each other.
NetworkMap readNetworkMap(const Hdf5Reader& file, const std::string& group) {
  NetworkMap map;
  const ReadFields fields(file, group);
  listMap(fields, map);
  map.validation = readValidation(file, group + "/validation");
  fields.require(fitsTogether(map));
  return map;
}

}  // namespace

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
