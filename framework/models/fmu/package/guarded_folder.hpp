#pragma once

#include <sys/types.h>

#include <filesystem>

namespace twinmap::fmi {

/// A folder below the system's folder for temporary files (TMPDIR) that is removed when this process ends, in
/// whatever way: a small process in a session of its own waits for that end, by a pipe that closes with it,
/// and removes the folder. Throws std::runtime_error if it cannot be made.
class GuardedFolder {
 public:
  GuardedFolder();
  GuardedFolder(const GuardedFolder&) = delete;
  GuardedFolder& operator=(const GuardedFolder&) = delete;
  /// Waits until the folder is gone.
  ~GuardedFolder();

  const std::filesystem::path& getPath() const { return path_; }

 private:
  void startGuard();

  std::filesystem::path path_;
  int pipe_ = -1;  ///< writing end: its closing is the sign
  pid_t guard_ = -1;
};

}  // namespace twinmap::fmi
