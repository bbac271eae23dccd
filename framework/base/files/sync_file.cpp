#include "framework/base/files/sync_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace twinmap {

void syncFile(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool failed = descriptor < 0 || ::fsync(descriptor) != 0;
  const int cause = errno;
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  if (failed) {
    throw std::runtime_error(path.string() + ": cannot be written to disk: " + std::strerror(cause));
  }
}

}  // namespace twinmap
