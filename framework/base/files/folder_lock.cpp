#include "framework/base/files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// "process 1234", or "another process" in the moment before it has written its number.
std::string describeOwner(int descriptor) {
  char text[24] = {};
  const ssize_t size = ::pread(descriptor, text, sizeof text - 1, 0);
  return size > 0 ? "process " + std::string(text, static_cast<std::size_t>(size)) : "another process";
}

/// Some network file systems have no locks. What they would prevent there does no harm: two runs of one
/// experiment write the same files, each whole.
bool isWithoutLocks(int error) {
  return error == ENOLCK || error == EOPNOTSUPP || error == ENOSYS;
}

/// Without the number the lock holds as well; it only tells less.
void writeOwner(int descriptor) {
  const std::string pid = std::to_string(::getpid());
  if (::ftruncate(descriptor, 0) == 0) {
    [[maybe_unused]] const ssize_t written = ::pwrite(descriptor, pid.data(), pid.size(), 0);
  }
}

}  // namespace

FileLock::FileLock(const fs::path& file, const std::string& locked, const std::string& instead)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) {
    throw std::runtime_error(file.string() + ": cannot be opened: " + std::strerror(errno));
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && !isWithoutLocks(errno)) {
    const std::string refusal = errno == EWOULDBLOCK
                                    ? locked + ": is in use by " + describeOwner(descriptor_) +
                                          "; wait until it has ended, or give " + instead
                                    : file.string() + ": cannot be locked: " + std::strerror(errno);
    ::close(descriptor_);
    throw std::runtime_error(refusal);
  }
  writeOwner(descriptor_);
}

FileLock::~FileLock() {
  [[maybe_unused]] const int emptied = ::ftruncate(descriptor_, 0);
  ::close(descriptor_);
}

std::string findLockOwner(const fs::path& folder) {
  const int descriptor = ::open((folder / "lock").c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return "";
  }
  const bool taken = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  const std::string owner = taken ? describeOwner(descriptor) : "";
  ::close(descriptor);
  return owner;
}

}  // namespace twinmap
