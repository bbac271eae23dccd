#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

namespace twinmap {

/// A file could not be written because the disk, or what one may have of it, is full.
class DiskFull : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a file whole or not at all: `write` fills a temporary file in the same folder, which is synced to
/// disk and renamed to `path`; then the folder is synced. Processes that write the same file, on whatever
/// machines, do not disturb each other: the last one's is there in the end. On an exception the temporary
/// file is removed and an older file at `path` stays as it was. Throws std::runtime_error naming the file and
/// the cause, a DiskFull where that is it.
void writeAtomically(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes in memory and for a text: "<path>: cannot be written: No space left on device".
void writeBytes(const std::filesystem::path& path, const void* bytes, std::size_t size);
void writeTextFile(const std::filesystem::path& path, const std::string& text);

/// Waits until what was written to a file is on the disk. Throws std::runtime_error naming the file and the
/// cause.
void syncFile(const std::filesystem::path& path);

/// The whole file. Throws std::runtime_error naming the file and the cause.
std::string readBytes(const std::filesystem::path& path);

/// Gives a file of the same folder another name, replacing what has it, and syncs the folder.
void renameFile(const std::filesystem::path& from, const std::filesystem::path& to);

/// Makes the folder and those above it, each synced into the one above.
void makeFolders(const std::filesystem::path& folder);

/// What the name of a temporary file ends with; one that is left was never complete.
inline constexpr const char* kTemporarySuffix = ".tmp";

/// The temporary file that becomes `path`: PATH.HOST-NAMESPACE-PID.tmp. No other process that may see the
/// folder has the same: the host's name is with the namespace that its process numbers are of.
std::filesystem::path getTemporaryPath(const std::filesystem::path& path);

/// Whether a temporary file is one of a process of this machine that no longer lives. What other machines
/// left cannot be judged from here, nor what bears no such name.
bool isAbandoned(const std::filesystem::path& temporary);

}  // namespace twinmap
