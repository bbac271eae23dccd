#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace twinmap::fmi {

/// What an archive held.
struct ArchiveContent {
  std::vector<std::string> files;      ///< relative paths of all files, '/' between the parts
  std::vector<std::string> platforms;  ///< folders of binaries/: "linux64", "x86_64-windows"
};

/// Unpacks an FMU, a ZIP archive, into `folder`, which exists and is empty: all but documentation and the
/// binaries of other platforms than `platforms`. All names are checked before anything is written. Throws
/// ExperimentError for a file that cannot be read or is not a ZIP archive, and for an entry that is absolute,
/// leads out of the folder
/// ("..") or is a link; also for more than a hundred thousand entries or 4 GiB. Nothing is written elsewhere.
ArchiveContent unpackArchive(const std::string& file, const std::filesystem::path& folder,
                             const std::vector<std::string>& platforms);

}  // namespace twinmap::fmi
