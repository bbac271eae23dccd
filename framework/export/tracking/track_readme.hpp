#pragma once

#include <string>

#include "framework/export/tracking/track_source.hpp"

namespace twinmap {

/// The part of README.md on the tracker: how it is called, what it needs, what it leaves out.
std::string makeTrackReadme(const ExportedModel& model, const ExportedTracking& tracking,
                            const std::string& prefix, const CTrackSource& source);

}  // namespace twinmap
