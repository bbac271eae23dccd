#pragma once

#include <filesystem>

namespace twinmap::fmi {

/// Writes fmi2Functions.h, fmi3Functions.h and what they include into a folder, which is made.
void writeStandardHeaders(const std::filesystem::path& folder);

}  // namespace twinmap::fmi
