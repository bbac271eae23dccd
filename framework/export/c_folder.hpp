#pragma once

#include <filesystem>
#include <iosfwd>

#include "framework/export/c_source.hpp"

namespace twinmap {

/// Writes a run's map as C into a folder, made where it is missing: PREFIX_map.h, PREFIX_map.c, selftest.c,
/// Makefile, README.md. Throws ExperimentError for a folder that cannot be written, and what
/// makeTestedMeasurements() throws.
void writeCFolder(const std::filesystem::path& run, const std::filesystem::path& folder,
                  const COptions& options, std::ostream& log);

}  // namespace twinmap
