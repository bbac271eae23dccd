#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace twinmap {

/// Writes a file whole or not at all: `write` fills a temporary file in the same folder, which is synced to
/// disk and renamed to `path`; then the folder is synced. On an exception the temporary file is removed and
/// an older file at `path` stays as it was. Throws std::runtime_error naming the file and the cause.
void writeAtomically(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for a text.
void writeTextFile(const std::filesystem::path& path, const std::string& text);

}  // namespace twinmap
