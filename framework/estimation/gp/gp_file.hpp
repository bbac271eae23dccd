#pragma once

#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/gp/gp_map.hpp"

namespace twinmap {

/// Writes all that a map of processes consists of below `group` (docs/reference/files.md).
void writeGpMap(Hdf5Writer& file, const std::string& group, const GpMap& map);

/// Reads it back; it predicts bit for bit as the one that was written. Throws std::runtime_error or
/// std::invalid_argument for parts that are missing or do not fit each other.
GpMap readGpMap(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
