#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/store/predictions_file.hpp"

namespace twinmap {

/// What two runs are compared by.
struct ComparedRun {
  std::string folder;
  YamlNode resolved;  ///< resolved.yaml
  std::vector<ParameterSpec> parameters;
  StoredPredictions test;
};

/// Reads a run's folder. Throws ExperimentError naming the folder if it is not that of a finished run, or
/// that of a sweep.
ComparedRun readComparedRun(const std::filesystem::path& folder);

}  // namespace twinmap
