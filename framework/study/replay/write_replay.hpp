#pragma once

#include <filesystem>

#include "framework/study/replay/replay.hpp"

namespace twinmap {

/// Writes replay.csv, residuals.csv, fit.csv, inference.json and report.html, each whole or not at all; makes
/// the folder. Throws std::runtime_error naming what cannot be written.
void writeReplay(const std::filesystem::path& folder, const MeasurementReader& reader, const Replay& replay);

}  // namespace twinmap
