#pragma once

#include <filesystem>

namespace twinmap {

/// A folder of its own below the system's folder for temporary files (TMPDIR), removed with all that is in it
/// at the end. Throws std::runtime_error if it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& getPath() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace twinmap
