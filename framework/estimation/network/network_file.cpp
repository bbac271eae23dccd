#include "framework/estimation/network/network_file.hpp"

#include <stdexcept>

#include "framework/estimation/surrogate/surrogate_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::string getLayerGroup(const std::string& group, std::size_t layer) {
  return group + "/layers/" + std::to_string(layer);
}

std::string getMemberGroup(const std::string& group, std::size_t member) {
  return group + "/members/" + std::to_string(member);
}

void writeMember(Hdf5Writer& file, const std::string& group, const network::Member& member) {
  const network::Network& network = member.network;
  file.write(group + "/regression/offset", network.offset);
  file.writeSamples(group + "/regression/weights", network.skip.transpose());
  file.write(group + "/regression/scale", network.scale);
  file.write(group + "/regression/squared", static_cast<double>(network.products.squared));
  file.write(group + "/regression/cubed", static_cast<double>(network.products.cubed));
  file.write(group + "/layers/count", static_cast<double>(network.layers.size()));
  for (std::size_t i = 0; i < network.layers.size(); ++i) {
    file.writeSamples(getLayerGroup(group, i) + "/weights", network.layers[i].weights.transpose());
    file.write(getLayerGroup(group, i) + "/biases", network.layers[i].biases);
  }
  if (member.last_layer.size() > 0) {
    file.writeSamples(group + "/last_layer", member.last_layer);
  }
}

network::Member readMember(const Hdf5Reader& file, const std::string& group) {
  network::Member member;
  network::Network& network = member.network;
  network.offset = file.readVector(group + "/regression/offset");
  network.skip = file.readSamples(group + "/regression/weights").transpose();
  network.scale = file.readVector(group + "/regression/scale");
  network.products = {file.readCount(group + "/regression/squared"),
                      file.readCount(group + "/regression/cubed")};
  const auto layers = static_cast<std::size_t>(file.readCount(group + "/layers/count"));
  for (std::size_t i = 0; i < layers; ++i) {
    network.layers.push_back({file.readSamples(getLayerGroup(group, i) + "/weights").transpose(),
                              file.readVector(getLayerGroup(group, i) + "/biases")});
  }
  if (file.contains(group + "/last_layer")) {
    member.last_layer = file.readSamples(group + "/last_layer");
  }
  return member;
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

}  // namespace

void writeNetworkMap(Hdf5Writer& file, const std::string& group, const NetworkMap& map) {
  file.write(group + "/inputs/center", map.inputs.center);
  file.writeSamples(group + "/inputs/projection", map.inputs.projection.transpose());
  file.write(group + "/inputs/known_center", map.inputs.known.center);
  file.write(group + "/inputs/known_half_width", map.inputs.known.half_width);
  file.write(group + "/center", map.center);
  file.write(group + "/half_width", map.half_width);
  file.write(group + "/members/count", static_cast<double>(map.members.size()));
  for (std::size_t i = 0; i < map.members.size(); ++i) {
    writeMember(file, getMemberGroup(group, i), map.members[i]);
  }
  writeValidation(file, group + "/validation", map.validation);
}

NetworkMap readNetworkMap(const Hdf5Reader& file, const std::string& group) {
  NetworkMap map;
  map.inputs = {
      file.readVector(group + "/inputs/center"),
      file.readSamples(group + "/inputs/projection").transpose(),
      {file.readVector(group + "/inputs/known_center"), file.readVector(group + "/inputs/known_half_width")}};
  map.center = file.readVector(group + "/center");
  map.half_width = file.readVector(group + "/half_width");
  const auto members = static_cast<std::size_t>(file.readCount(group + "/members/count"));
  for (std::size_t i = 0; i < members; ++i) {
    map.members.push_back(readMember(file, getMemberGroup(group, i)));
  }
  map.validation = readValidation(file, group + "/validation");
  if (!fitsTogether(map)) {
    throw std::runtime_error(file.getPath() + ": " + group + " has parts that do not fit each other");
  }
  return map;
}

}  // namespace twinmap
