#pragma once

#include <string>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// Applies one "key.path=value" to the tree: "noise.scale=4", "parameters.k_y.bounds=[1, 2]",
/// "system.springs[0].stiffness=2*k_y". The value is YAML. Maps on the way are created; a list index must
/// exist. Keys that mean nothing are found when the tree is read. A list with commas outside brackets and
/// quotes, "seed=1,2,3", or a range, "seed=1..10", sweeps the key (sweep.over); a single value ends a sweep
/// of the key. Throws ExperimentError for a malformed override.
void applyOverride(YamlNode& root, const std::string& override_text);

/// Puts a value at a key path; both keep their places for messages. Throws ExperimentError as
/// applyOverride().
void setValue(YamlNode& root, const Name& key, const YamlNode& value);

/// The value at a key path, or null. Throws ExperimentError for a malformed path.
const YamlNode* findValue(const YamlNode& root, const Name& key);

}  // namespace twinmap
