#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/estimation/gp/gp_map.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/store/estimators/map_summary.hpp"

namespace twinmap {

/// A trained map with the names of what goes in and comes out, and what measurements need.
struct StoredMap {
  std::vector<ParameterSpec> parameters;
  std::vector<std::string> feature_names;
  GpMap map;                            ///< exact; without processes where the map is of another kind
  std::vector<ParameterSpec> inputs{};  ///< known, with a measurement; their bounds scale them
  OnlineModel online{};                 ///< written where there is an experiment; not read back
  std::string experiment{};             ///< resolved.yaml's text, for the online model
};

/// What infers from measurements.
struct StoredOnlineModel {
  OnlineModel model;
  std::string experiment;  ///< resolved.yaml's text
};

/// Writes maps.h5 (docs/file-formats.md): all that is needed to predict. Equal content gives equal bytes.
void writeMapsFile(const std::filesystem::path& path, const StoredMap& stored);

/// Reads it back; predictions are those of the map that was written, bit for bit. Throws std::runtime_error
/// for a file that is not a maps.h5, or that of another map.
StoredMap readMapsFile(const std::filesystem::path& path);

/// Whether the map is one of processes; surrogates and networks are not. Throws std::runtime_error for a file
/// that is not a maps.h5.
bool holdsProcesses(const std::filesystem::path& path);

/// Reads the online model alone, a fraction of the file. Throws std::runtime_error for a file that is no
/// maps.h5 or has none.
StoredOnlineModel readOnlineModel(const std::filesystem::path& path);

}  // namespace twinmap
