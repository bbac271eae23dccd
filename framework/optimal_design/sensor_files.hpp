#pragma once

#include <filesystem>
#include <string>

#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/optimal_design/sensor_design.hpp"

namespace twinmap::experiment_design {

/// The names of chosen outputs, with spaces between them.
std::string nameOutputs(const SensorDesign& design, const Subset& outputs);

/// The experiment whose features are the samples chosen: one entry for each stretch of equidistant times.
YamlNode makeDesignedTree(const YamlNode& tree, const SensorDesign& design);

/// Writes designed.yaml, sensors.csv (count, outputs, criterion, then sd_NAME of each parameter, the mean of
/// the limit over the box) and, where times were chosen, times.csv (count, criterion, sd_NAME).
void writeSensorDesign(const std::filesystem::path& folder, const YamlNode& tree, const SensorDesign& design);

/// For people: the choices of each number of outputs and their limits.
std::string describeSensors(const SensorDesign& design);

}  // namespace twinmap::experiment_design
