#include "framework/store/estimators/network_group.hpp"

namespace twinmap {
namespace {

std::string getLayerGroup(const std::string& group, std::size_t layer) {
  return group + "/layers/" + std::to_string(layer);
}

/// One network stands in the map's own group, as before there were several.
std::string getMemberGroup(const std::string& group, std::size_t member) {
  return member == 0 ? group : group + "/members/" + std::to_string(member);
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
  network.products = {static_cast<Eigen::Index>(file.readNumber(group + "/regression/squared")),
                      static_cast<Eigen::Index>(file.readNumber(group + "/regression/cubed"))};
  const auto layers = static_cast<std::size_t>(file.readNumber(group + "/layers/count"));
  for (std::size_t i = 0; i < layers; ++i) {
    network.layers.push_back({file.readSamples(getLayerGroup(group, i) + "/weights").transpose(),
                              file.readVector(getLayerGroup(group, i) + "/biases")});
  }
  if (file.contains(group + "/last_layer")) {
    member.last_layer = file.readSamples(group + "/last_layer");
  }
  return member;
}

}  // namespace

void writeNetworkGroup(Hdf5Writer& file, const std::string& group, const NetworkMap& map) {
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
}

NetworkMap readNetworkGroup(const Hdf5Reader& file, const std::string& group) {
  NetworkMap map;
  map.inputs = {
      file.readVector(group + "/inputs/center"),
      file.readSamples(group + "/inputs/projection").transpose(),
      {file.readVector(group + "/inputs/known_center"), file.readVector(group + "/inputs/known_half_width")}};
  map.center = file.readVector(group + "/center");
  map.half_width = file.readVector(group + "/half_width");
  const std::string count = group + "/members/count";
  const auto members = static_cast<std::size_t>(file.contains(count) ? file.readNumber(count) : 1.0);
  for (std::size_t i = 0; i < members; ++i) {
    map.members.push_back(readMember(file, getMemberGroup(group, i)));
  }
  return map;
}

}  // namespace twinmap
