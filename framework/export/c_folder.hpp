#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>

#include "framework/estimation/gp/gp_map.hpp"
#include "framework/experiment/tracking_spec.hpp"
#include "framework/export/c_code/c_source.hpp"

namespace twinmap {

/// What of a run is written as C.
struct CFolderOptions {
  COptions c;
  bool track = false;                      ///< a tracker beside the map
  std::optional<TrackingSpec> tracking{};  ///< of it; none: all parameters walk at unknown rates
  bool trust = true;                       ///< else measurements are not judged
  /// For a compressed map: the exact processes of the run's experiment, of which it has the compressed ones.
  std::function<GpMap(const ExperimentSpec& experiment, const GpMap& deployed)> make_exact{};
};

/// Writes a run's map as C into a folder, made where it is missing: PREFIX_map.h, PREFIX_map.c, selftest.c,
/// Makefile, README.md. A tracker adds PREFIX_track.h, PREFIX_track.c and track_selftest.c. Throws
/// ExperimentError for a folder that cannot be written, a map that cannot be compressed, and what
/// makeTestedMeasurements() throws.
void writeCFolder(const std::filesystem::path& run, const std::filesystem::path& folder,
                  const CFolderOptions& options, std::ostream& log);

}  // namespace twinmap
