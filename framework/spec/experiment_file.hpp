#pragma once

#include <string>
#include <vector>

#include "framework/spec/experiment_spec.hpp"
#include "framework/spec/yaml_node.hpp"

namespace twinmap {

/// Reads an experiment from its YAML tree and checks it (see check_experiment.hpp).
/// Throws ExperimentError for the first thing wrong.
ExperimentSpec readExperiment(const YamlNode& root);

/// Reads `path`, applies the overrides "key.path=value" in their order, checks the result.
ExperimentSpec loadExperiment(const std::string& path, const std::vector<std::string>& overrides = {});

/// The experiment as YAML with every default written out; reading it back gives the same experiment.
std::string writeExperiment(const ExperimentSpec& experiment);

}  // namespace twinmap
