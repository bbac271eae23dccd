#pragma once

#include <filesystem>
#include <string>

#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/files/table.hpp"

namespace twinmap::cli {

/// The experiment's file; of a run that it keeps. Throws MeasurementError for a recording.
inline std::string findExperimentFile(const std::string& run) {
  refuseRecording(run);
  const std::filesystem::path resolved = std::filesystem::path(run) / "resolved.yaml";
  return std::filesystem::is_directory(run) && std::filesystem::exists(resolved) ? resolved.string() : run;
}

}  // namespace twinmap::cli
