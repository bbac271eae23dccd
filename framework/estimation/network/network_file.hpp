#pragma once

#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/network/network_map.hpp"

namespace twinmap {

/// Writes inputs, bounds, weights and validation of a network below `group` (docs/reference/files.md).
void writeNetworkMap(Hdf5Writer& file, const std::string& group, const NetworkMap& map);

/// Reads it back; it predicts bit for bit as the one that was written. Throws std::runtime_error for parts
/// that are missing or do not fit each other.
NetworkMap readNetworkMap(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
