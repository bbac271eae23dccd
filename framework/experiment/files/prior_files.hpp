#pragma once

#include <string>

#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// Replaces each `from: FILE` in `priors` by the joint_normal that the file states: the mean and covariance
/// of the first estimate in it (a line of `twinmap infer --json`), of those parameters that the experiment
/// has. Names of files are relative to the folder of `path`. Throws ExperimentError for a file that cannot be
/// read or has no such estimate.
void resolvePriorFiles(YamlNode& root, const std::string& path);

}  // namespace twinmap
