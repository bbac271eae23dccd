#pragma once

#include <filesystem>
#include <string>

namespace twinmap {

/// Keeps a folder for one owner as long as it lives: a second one, in another process or this one, is refused
/// with an error that names the folder and the owner's process. The lock is the operating system's (flock on
/// the file `lock` in the folder), so that it dies with its owner, however that ends; the file stays, empty.
/// On a file system that has no locks nobody is refused.
class FolderLock {
 public:
  /// The folder must exist. Throws std::runtime_error if it is in use or cannot be locked.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

/// "process 1234", if someone has the folder's lock, else "". Takes the lock for a moment to find out.
std::string findLockOwner(const std::filesystem::path& folder);

}  // namespace twinmap
