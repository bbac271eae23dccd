#include "framework/store/network_group.hpp"

namespace twinmap {
namespace {

std::string getLayerGroup(const std::string& group, std::size_t layer) {
  return group + "/layers/" + std::to_string(layer);
}

}  // namespace

void writeNetworkGroup(Hdf5Writer& file, const std::string& group, const NetworkMap& map) {
  file.write(group + "/inputs/center", map.inputs.center);
  file.writeSamples(group + "/inputs/projection", map.inputs.projection.transpose());
  file.write(group + "/inputs/known_center", map.inputs.known.center);
  file.write(group + "/inputs/known_half_width", map.inputs.known.half_width);
  file.write(group + "/center", map.center);
  file.write(group + "/half_width", map.half_width);
  file.write(group + "/regression/offset", map.network.offset);
  file.writeSamples(group + "/regression/weights", map.network.skip.transpose());
  file.write(group + "/regression/scale", map.network.scale);
  file.write(group + "/regression/squared", static_cast<double>(map.network.products.squared));
  file.write(group + "/regression/cubed", static_cast<double>(map.network.products.cubed));
  file.write(group + "/layers/count", static_cast<double>(map.network.layers.size()));
  for (std::size_t i = 0; i < map.network.layers.size(); ++i) {
    file.writeSamples(getLayerGroup(group, i) + "/weights", map.network.layers[i].weights.transpose());
    file.write(getLayerGroup(group, i) + "/biases", map.network.layers[i].biases);
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
  map.network.offset = file.readVector(group + "/regression/offset");
  map.network.skip = file.readSamples(group + "/regression/weights").transpose();
  map.network.scale = file.readVector(group + "/regression/scale");
  map.network.products = {static_cast<Eigen::Index>(file.readNumber(group + "/regression/squared")),
                          static_cast<Eigen::Index>(file.readNumber(group + "/regression/cubed"))};
  const auto layers = static_cast<std::size_t>(file.readNumber(group + "/layers/count"));
  for (std::size_t i = 0; i < layers; ++i) {
    map.network.layers.push_back({file.readSamples(getLayerGroup(group, i) + "/weights").transpose(),
                                  file.readVector(getLayerGroup(group, i) + "/biases")});
  }
  return map;
}

}  // namespace twinmap
