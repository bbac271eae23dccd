#pragma once

#include <optional>
#include <string>

#include "framework/experiment/tracking_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// The key of what is beside an experiment and no part of it.
constexpr const char* kTrackingKey = "tracking";

/// The section `tracking:` of an experiment file, or of another file, which may have nothing else. None where
/// there is none. Not checked against a model yet (checkTracking()). Throws ExperimentError.
std::optional<TrackingSpec> loadTracking(const std::string& path);

/// The same of a file's tree.
std::optional<TrackingSpec> readTracking(const YamlNode& root);

/// As YAML, with every default written out.
std::string writeTracking(const TrackingSpec& tracking);

}  // namespace twinmap
