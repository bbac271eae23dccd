#pragma once

#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"

namespace twinmap {

/// Writes all numbers of a forward surrogate below `group` (docs/reference/files.md): those of all windows
/// side by side, so that reading takes a few calls however many windows there are.
void writeForward(Hdf5Writer& file, const std::string& group, const ForwardSurrogate& surrogate);

/// Reads it back; it predicts bit for bit as the one that was written. Throws std::runtime_error for unknown
/// names, std::invalid_argument for sizes that do not fit each other.
ForwardSurrogate readForward(const Hdf5Reader& file, const std::string& group);

/// A prior of the unknowns below `group`; nothing where it is uniform. Reading throws std::runtime_error for
/// another number of unknowns.
void writePrior(Hdf5Writer& file, const std::string& group, const BoxPrior& prior);
BoxPrior readPrior(const Hdf5Reader& file, const std::string& group, Eigen::Index unknown);

/// A surrogate as a map: its forward part, the box and the validation. Errors as above.
void writeSurrogate(Hdf5Writer& file, const std::string& group, const Surrogate& surrogate);
Surrogate readSurrogate(const Hdf5Reader& file, const std::string& group);

/// Writes what is known of the errors of a map below `group` (docs/reference/files.md).
void writeValidation(Hdf5Writer& file, const std::string& group, const SurrogateValidation& validation);

/// Reads it back. Throws std::runtime_error for parts that are missing.
SurrogateValidation readValidation(const Hdf5Reader& file, const std::string& group);

/// Whether it is of so many parameters; limits, which only some maps have, aside.
bool fitsParameters(const SurrogateValidation& validation, Eigen::Index parameters);

}  // namespace twinmap
