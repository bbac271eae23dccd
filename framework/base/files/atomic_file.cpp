#include "framework/base/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace twinmap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  const std::string message = path.string() + ": " + what + ": " + std::strerror(error);
  if (error == ENOSPC || error == EDQUOT) {
    throw DiskFull(message);
  }
  throw std::runtime_error(message);
}

/// ".HOST-NAMESPACE-": what the temporary files of all processes that can see one another have in common.
const std::string& getMachineTag() {
  static const std::string tag = [] {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    struct stat ids {};
    ::stat("/proc/self/ns/pid", &ids);
    return "." + std::string(host.data()) + "-" + std::to_string(ids.st_ino) + "-";
  }();
  return tag;
}

/// For what other libraries fail to write without saying why.
bool isFull(const fs::path& folder) {
  constexpr std::uintmax_t kMin = 1u << 16;
  std::error_code error;
  const fs::space_info space = fs::space(folder.empty() ? fs::path(".") : folder, error);
  return !error && space.available < kMin;
}

/// An open file; closing reports what the disk did not take until then.
class OpenFile {
 public:
  OpenFile(const fs::path& path, int flags) : path_(path), descriptor_(::open(path.c_str(), flags, 0666)) {
    if (descriptor_ < 0) {
      fail(path_, "cannot be opened", errno);
    }
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }

  void write(const char* bytes, std::size_t size) const {
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, bytes, size);
      if (written < 0 && errno != EINTR) {
        fail(path_, "cannot be written", errno);
      }
      const std::size_t done = written < 0 ? 0 : static_cast<std::size_t>(written);
      bytes += done;
      size -= done;
    }
  }

  /// Reads up to `size` bytes; 0 at the end.
  std::size_t read(char* bytes, std::size_t size) const {
    ssize_t count = ::read(descriptor_, bytes, size);
    while (count < 0 && errno == EINTR) {
      count = ::read(descriptor_, bytes, size);
    }
    if (count < 0) {
      fail(path_, "cannot be read", errno);
    }
    return static_cast<std::size_t>(count);
  }

  void sync() const {
    if (::fsync(descriptor_) != 0) {
      fail(path_, "cannot be written to disk", errno);
    }
  }

  void close() {
    if (::close(std::exchange(descriptor_, -1)) != 0) {
      fail(path_, "cannot be written to disk", errno);
    }
  }

 private:
  const fs::path& path_;
  int descriptor_;
};

void syncFolder(const fs::path& folder) {
  const fs::path path = folder.empty() ? fs::path(".") : folder;
  OpenFile(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC).sync();
}

void writeOrSayFull(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  try {
    write(file);
  } catch (const DiskFull&) {
    throw;
  } catch (const std::exception&) {
    if (isFull(file.parent_path())) {
      fail(file, "cannot be written", ENOSPC);
    }
    throw;
  }
}

}  // namespace

fs::path getTemporaryPath(const fs::path& path) {
  return path.string() + getMachineTag() + std::to_string(::getpid()) + kTemporarySuffix;
}

bool isAbandoned(const fs::path& temporary) {
  const std::string name = temporary.filename().string();
  const std::size_t tag = name.rfind(getMachineTag());
  if (tag == std::string::npos || temporary.extension() != kTemporarySuffix) {
    return false;
  }
  const pid_t pid = std::atoi(name.c_str() + tag + getMachineTag().size());
  return pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH;
}

void writeAtomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = getTemporaryPath(path);
  try {
    writeOrSayFull(temporary, write);
    syncFile(temporary);
    renameFile(temporary, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

void syncFile(const fs::path& path) {
  OpenFile(path, O_RDONLY | O_CLOEXEC).sync();
}

void writeBytes(const fs::path& path, const void* bytes, std::size_t size) {
  writeAtomically(path, [&](const fs::path& temporary) {
    OpenFile file(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
    file.write(static_cast<const char*>(bytes), size);
    file.close();
  });
}

void writeTextFile(const fs::path& path, const std::string& text) {
  writeBytes(path, text.data(), text.size());
}

std::string readBytes(const fs::path& path) {
  const OpenFile file(path, O_RDONLY | O_CLOEXEC);
  std::string bytes(fs::file_size(path), '\0');
  std::size_t size = 0;
  while (size < bytes.size()) {
    const std::size_t count = file.read(bytes.data() + size, bytes.size() - size);
    if (count == 0) {
      break;
    }
    size += count;
  }
  bytes.resize(size);
  return bytes;
}

void renameFile(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    fail(from, "cannot be renamed to " + to.filename().string(), error.value());
  }
  syncFolder(to.parent_path());
}

void makeFolders(const fs::path& folder) {
  if (fs::is_directory(folder)) {
    return;
  }
  if (folder.has_parent_path()) {
    makeFolders(folder.parent_path());
  }
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    fail(folder, "cannot be created", error.value());
  }
  syncFolder(folder.parent_path());
}

}  // namespace twinmap
