#pragma once

#include <filesystem>

#include "framework/base/log/run_control.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/optimal_design/sensor_design.hpp"

namespace twinmap::experiment_design {

/// Chooses which outputs to measure, and at which of the features' sample times, for an experiment with
/// design.sensors, and writes to `folder`: designed.yaml, the whole experiment with these as its features;
/// sensors.csv and times.csv, what each further one buys; sensors.html. Each choice is greedy, then improved
/// by exchanges, for 1, 2, 3 ... outputs up to all; the criterion is averaged over a Latin hypercube of the
/// box; nuisance parameters are marginalised, the box is the prior, and correlated noise is what it is among
/// the samples that are chosen. Throws ExperimentError where features are no samples on one grid of times;
/// Interrupted. Cost: a simulation with derivatives for each point.
SensorDesign designSensors(const YamlNode& tree, const std::filesystem::path& folder,
                           const RunControl& control);

}  // namespace twinmap::experiment_design
