#pragma once

#include "framework/export/c_code/c_source.hpp"
#include "framework/export/model/exported_tracking.hpp"

namespace twinmap {

/// A tracker in C99 beside a map: PREFIX_track.h and PREFIX_track.c.
struct CTrackSource {
  std::string header, source;
  CSizes sizes;
  std::size_t bytes = 0;  ///< of constants
};

/// Throws std::runtime_error for numbers that are not finite.
CTrackSource makeTrackSource(const ExportedModel& model, const ExportedTracking& tracking,
                             const std::string& prefix);

}  // namespace twinmap
