#pragma once

#include <string>
#include <vector>

#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// A key whose values differ; a key that one side lacks has "nothing" there.
struct KeyDifference {
  std::string key;  ///< "noise.scale"
  std::string before, after;
};

/// What differs between two experiments as writeExperiment() writes them. The order of keys and descriptions
/// make no difference; the order of parameters and outputs does, for results are in that order.
std::vector<KeyDifference> compareTrees(const YamlNode& before, const YamlNode& after);

}  // namespace twinmap
