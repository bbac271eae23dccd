#include "framework/models/fmu/package/guarded_folder.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace twinmap::fmi {
namespace {

/// Reads until the pipe is closed, whatever signals come, and removes its folder.
constexpr const char* kGuardScript = R"(trap '' HUP INT TERM QUIT; cd /; read -r line; exec rm -rf -- "$1")";

}  // namespace

GuardedFolder::GuardedFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "twinmap-fmu.XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error(pattern + ": cannot be made: " + std::strerror(errno));
  }
  path_ = pattern;
  startGuard();
}

void GuardedFolder::startGuard() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    std::filesystem::remove_all(path_);
    throw std::runtime_error(std::string("no pipe can be made: ") + std::strerror(errno));
  }
  pipe_ = ends[1];
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSID);  // no signal of the terminal or the group reaches it
  std::string script = kGuardScript, path = path_.string(), shell = "sh", option = "-c",
              name = "twinmap-guard";
  char* arguments[] = {shell.data(), option.data(), script.data(), name.data(), path.data(), nullptr};
  const int error = posix_spawn(&guard_, "/bin/sh", &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(ends[0]);
  if (error != 0) {
    close(pipe_);
    std::filesystem::remove_all(path_);
    throw std::runtime_error(std::string("/bin/sh cannot be started: ") + std::strerror(error));
  }
}

GuardedFolder::~GuardedFolder() {
  close(pipe_);
  while (waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace twinmap::fmi
