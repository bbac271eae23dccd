#pragma once

#include <filesystem>
#include <string>

namespace twinmap {

/// Keeps something for one owner as long as it lives: a second one, in another process or this one, is
/// refused with an error that names it and the owner's process. The lock is the operating system's (flock on
/// a file), so that it dies with its owner, however that ends; the file stays, empty. On a file system that
/// has no locks nobody is refused.
class FileLock {
 public:
  /// file: made where it is not there, in a folder that exists. locked: what it keeps; instead: what to give
  /// in its place. Throws std::runtime_error if it is in use or cannot be locked.
  FileLock(const std::filesystem::path& file, const std::string& locked, const std::string& instead);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  int descriptor_;
};

/// Keeps a folder, which must exist, by the file `lock` in it.
class FolderLock : public FileLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : FileLock(folder / "lock", folder.string(), "another folder") {}
};

/// "process 1234", if someone has the folder's lock, else "". Takes the lock for a moment to find out.
std::string findLockOwner(const std::filesystem::path& folder);

}  // namespace twinmap
