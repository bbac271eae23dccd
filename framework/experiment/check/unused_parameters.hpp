#pragma once

#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// The parameters of a section ("parameters", "nuisance") whose names stand nowhere else in the description
/// of the machine, its experiment and its measurement. None of a model from elsewhere.
std::vector<std::string> listUnused(const YamlNode& experiment, const std::string& section);
std::vector<std::string> listUnused(ExperimentSpec experiment, const std::string& section);

/// "parameters.NAME: nothing uses ..." of each parameter whose name stands nowhere else in the description of
/// the machine, its experiment and its measurement. Nothing of a model from elsewhere, which knows its
/// parameters itself.
std::vector<std::string> listUnusedParameters(const YamlNode& experiment);

}  // namespace twinmap
