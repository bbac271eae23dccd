#include <fmt/core.h>

#include <algorithm>

#include "framework/export/c_code/c_model_tables.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

void addInputScales(const NetworkInputs& inputs, CTables& tables) {
  tables.addWide("input_center", inputs.center, "Mean of the features, in their units.");
  tables.addWide("input_projection", flattenRows(inputs.projection),
                 fmt::format("Inputs per unit of the features, {} x {}, input by input.",
                             inputs.projection.rows(), inputs.projection.cols()));
  if (inputs.known.center.size() > 0) {
    tables.addWide("known_center", inputs.known.center, "Middle of the known inputs' bounds.");
    tables.addWide("known_half_width", inputs.known.half_width, "Half of their width.");
  }
}

/// The regression decides all digits of a mean, the layers a residual's first ones.
void addRegression(const network::Network& network, CTables& tables) {
  const Index k = network.countInputs(), products = network.products.count();
  tables.addWide("target_offset", network.offset, "Where the regression begins, on [-1, 1] of the bounds.");
  tables.addWide("regression_linear", flattenRows(network.skip.leftCols(k)),
                 "Of each parameter, its slopes with respect to the inputs.");
  if (products > 0) {
    tables.addWide("regression_products", flattenRows(network.skip.rightCols(products)),
                   "And with respect to their products.");
  }
  tables.addWide("target_scale", network.scale, "Standard deviation of what the regression leaves.");
}

void addLayers(const network::Network& network, CTables& tables, CSizes& sizes) {
  std::vector<std::string> entries;
  Index widest = 0;
  for (const network::Layer& layer : network.layers) {
    const std::string name = fmt::format("layer_{}", entries.size());
    tables.addReal(
        name + "_weights", flattenColumns(layer.weights),
        fmt::format("{} outputs x {} inputs, input by input.", layer.weights.rows(), layer.weights.cols()));
    tables.addReal(name + "_biases", layer.biases, "What is added to them.");
    entries.push_back(
        fmt::format("{}, {}, {}_weights, {}_biases", layer.weights.cols(), layer.weights.rows(), name, name));
    widest = std::max(widest, layer.biases.size());
  }
  tables.addStructs("layer", "layers", entries, "Hidden layers, then the head.");
  sizes.push_back({"LAYERS", static_cast<long>(entries.size()), "of the network, its head included"});
  sizes.push_back({"WIDEST", static_cast<long>(widest), "outputs of the widest"});
}

}  // namespace

void addNetwork(const NetworkMap& map, CTables& tables, CSizes& sizes) {
  const network::Products& products = map.members.front().network.products;
  addInputScales(map.inputs, tables);
  addRegression(map.members.front().network, tables);
  addLayers(map.members.front().network, tables, sizes);
  tables.addWide("parameter_center", map.center, "Middle of the parameters' bounds.");
  tables.addWide("parameter_half_width", map.half_width, "Half of their width.");
  tables.addWide("stddev_scale", map.validation.stddev_scale,
                 "By which standard deviations are multiplied (cross-validation).");
  sizes.push_back({"INPUTS", static_cast<long>(map.inputs.projection.rows()), "inputs of the map"});
  sizes.push_back({"SQUARED", static_cast<long>(products.squared), "inputs whose products the map takes"});
  sizes.push_back({"CUBED", static_cast<long>(products.cubed), "inputs whose triple products it takes"});
  sizes.push_back({"PRODUCTS", static_cast<long>(products.count()), "all of these products"});
}

}  // namespace twinmap
