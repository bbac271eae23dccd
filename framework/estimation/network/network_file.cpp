#include "framework/estimation/network/network_file.hpp"

#include "framework/base/hdf5/hdf5_fields.hpp"
#include "framework/estimation/surrogate/surrogate_file.hpp"

namespace twinmap {
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

}  // namespace

void writeNetworkMap(Hdf5Writer& file, const std::string& group, const NetworkMap& map) {
  listMap(WrittenFields(file, group), map);
  writeValidation(file, group + "/validation", map.validation);
}

NetworkMap readNetworkMap(const Hdf5Reader& file, const std::string& group) {
  NetworkMap map;
  const ReadFields fields(file, group);
  listMap(fields, map);
  map.validation = readValidation(file, group + "/validation");
  fields.require(fitsTogether(map));
  return map;
}

}  // namespace twinmap
