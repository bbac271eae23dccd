#pragma once

#include <string>

#include "framework/spec/yaml_node.hpp"

namespace twinmap {

/// Applies one "key.path=value" to the tree: "noise.scale=4", "parameters.k_y.bounds=[1, 2]",
/// "system.springs[0].stiffness=2*k_y". The value is YAML. Maps on the way are created; a list index must
/// exist. Keys that mean nothing are found when the tree is read. Throws ExperimentError for a malformed
/// override.
void applyOverride(YamlNode& root, const std::string& override_text);

}  // namespace twinmap
