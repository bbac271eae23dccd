#pragma once

#include <filesystem>
#include <string>

#include "framework/base/log/run_control.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap::experiment_design {

/// Runs the experiment as it was and as it was designed (FOLDER/designed.yaml), with the same number of
/// training simulations, into FOLDER/verify/before and after, and compares what their maps infer on held-out
/// samples with noise: the text of `twinmap compare`, which is written to verify/comparison.txt too. Where
/// the number is automatic both take the most that it allows. Throws as runExperiment().
std::string verifyDesign(const YamlNode& tree, const std::filesystem::path& folder,
                         const RunControl& control);

}  // namespace twinmap::experiment_design
