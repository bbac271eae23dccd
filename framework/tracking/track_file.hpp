#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "framework/tracking/tracked_twin.hpp"

namespace twinmap {

/// What a state file belongs to: another run, estimator or section `tracking:` is refused.
struct TrackIdentity {
  std::string run;       ///< the experiment's name
  std::string digest;    ///< of the experiment
  std::string tracking;  ///< as YAML, "" where there is none
};

/// Writes base and window of a twin, sealed with a digest, whole or not at all. history_bytes: what of the
/// history belongs to it.
void writeTrackFile(const std::filesystem::path& path, const TrackIdentity& identity, const TrackedTwin& twin,
                    std::uint64_t history_bytes);

struct LoadedTrack {
  TrackedTwin twin;
  std::uint64_t history_bytes = 0;
};

/// None where there is no file. Throws std::runtime_error naming the file for one that is damaged, of another
/// version, or of another identity, and says which.
std::optional<LoadedTrack> readTrackFile(const std::filesystem::path& path, const TrackIdentity& identity,
                                         const tracking::Model& model, int lag);

}  // namespace twinmap
