#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/inverse_map/gp_map.hpp"
#include "framework/spec/model_spec.hpp"
#include "framework/store/map_summary.hpp"

namespace twinmap {

/// A trained map with the names of what goes in and comes out.
struct StoredMap {
  std::vector<ParameterSpec> parameters;
  std::vector<std::string> feature_names;
  GpMap map;
  std::vector<ParameterSpec> inputs{};  ///< known, with a measurement; their bounds scale them
};

/// Writes maps.h5 (docs/file-formats.md): all that is needed to predict. Equal content gives equal bytes.
void writeMapsFile(const std::filesystem::path& path, const StoredMap& stored);

/// Reads it back; predictions are those of the map that was written, bit for bit. Throws std::runtime_error
/// for a file that is no maps.h5.
StoredMap readMapsFile(const std::filesystem::path& path);

}  // namespace twinmap
