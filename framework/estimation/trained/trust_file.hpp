#pragma once

#include <memory>
#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/trained/trust_model.hpp"

namespace twinmap {

/// Writes a trust model below `group` (docs/reference/files.md); its surrogate only where that is not the
/// map's own (`of_map`; may be null).
void writeTrustModel(Hdf5Writer& file, const std::string& group, const TrustModel& trust,
                     const ForwardSurrogate* of_map);

/// Reads it back. Throws std::runtime_error or std::invalid_argument for parts that are missing or do not fit
/// each other.
TrustModel readTrustModel(const Hdf5Reader& file, const std::string& group,
                          std::shared_ptr<const ForwardSurrogate> of_map);

}  // namespace twinmap
