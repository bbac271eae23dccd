#pragma once

#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"

namespace twinmap {

/// Writes what is known of the errors of a map below `group` (docs/file-formats.md).
void writeValidation(Hdf5Writer& file, const std::string& group, const SurrogateValidation& validation);

/// Reads it back. Throws std::runtime_error for parts that are missing.
SurrogateValidation readValidation(const Hdf5Reader& file, const std::string& group);

/// Whether it is of so many parameters; limits, which only some maps have, aside.
bool fitsParameters(const SurrogateValidation& validation, Eigen::Index parameters);

}  // namespace twinmap
