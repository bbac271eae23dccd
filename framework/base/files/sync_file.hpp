#pragma once

#include <filesystem>

namespace twinmap {

/// Waits until what was written to a file is on the disk. Throws std::runtime_error naming the file and the
/// cause.
void syncFile(const std::filesystem::path& path);

}  // namespace twinmap
