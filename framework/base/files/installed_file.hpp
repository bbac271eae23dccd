#pragma once

#include <filesystem>

namespace twinmap {

/// The folder of the program or library that this code is in, links resolved.
std::filesystem::path findOwnFolder();

/// A file or folder that is installed with it, by its path below the prefix ("share/twinmap/units"): in the
/// folder of the program or library or one above it, which holds for an installation anywhere, an archive and
/// the folder of a build, or in the Python package below one of these
/// (PREFIX/lib/python3.11/site-packages/twinmap, FOLDER/twinmap of pip's --target). "" where it is nowhere.
std::filesystem::path findInstalled(const std::filesystem::path& path);

}  // namespace twinmap
