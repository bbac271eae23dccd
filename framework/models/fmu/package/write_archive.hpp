#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace twinmap::fmi {

/// A file of an archive.
struct ArchiveFile {
  std::string name;  ///< relative, '/' between the parts
  std::string content;
};

/// Writes a ZIP archive whole or not at all; equal files give equal bytes. Throws std::runtime_error for a
/// path that cannot be written.
void writeArchive(const std::filesystem::path& path, const std::vector<ArchiveFile>& files);

}  // namespace twinmap::fmi
