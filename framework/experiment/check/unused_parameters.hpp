#pragma once

#include <string>
#include <vector>

#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// "parameters.NAME: nothing uses ..." of each parameter whose name stands nowhere else in the description of
/// the machine, its experiment and its measurement. Nothing of a model from elsewhere, which knows its
/// parameters itself.
std::vector<std::string> listUnusedParameters(const YamlNode& experiment);

}  // namespace twinmap
