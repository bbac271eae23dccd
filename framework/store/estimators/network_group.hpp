#pragma once

#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/network/network_map.hpp"

namespace twinmap {

/// Writes inputs, bounds and weights of a network below `group` (docs/file-formats.md).
void writeNetworkGroup(Hdf5Writer& file, const std::string& group, const NetworkMap& map);

/// Reads them back, without the validation.
NetworkMap readNetworkGroup(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
