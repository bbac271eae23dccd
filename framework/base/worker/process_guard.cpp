#include "framework/base/worker/process_guard.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>

#include "framework/base/worker/worker_process.hpp"

namespace twinmap {
namespace {

/// Positive: a group to guard; negative: one to forget. Written whole, as it is shorter than a pipe's buffer.
using Record = int;

constexpr int kMaxGroups = 4096;  // far above the number of workers at a time

/// The guard's life. It may use async-signal-safe functions only, as the process it was forked from has
/// threads.
[[noreturn]] void guard(int channel) {
  setsid();  // no signal of the terminal reaches it
  for (const int number : {SIGHUP, SIGINT, SIGTERM, SIGQUIT, SIGPIPE}) {
    signal(number, SIG_IGN);
  }
  prctl(PR_SET_NAME, "twinmap-guard");
  dup2(channel, STDIN_FILENO);
  close_range(STDIN_FILENO + 1, ~0U, 0);
  static Record groups[kMaxGroups];
  int count = 0;
  Record record = 0;
  ssize_t size = 0;
  while ((size = read(STDIN_FILENO, &record, sizeof record)) != 0) {
    if (size < 0 && errno != EINTR) {
      break;
    }
    if (size == sizeof record && record > 0 && count < kMaxGroups) {
      groups[count++] = record;
    } else if (size == sizeof record && record < 0) {
      Record* const found = std::find(groups, groups + count, -record);
      if (found != groups + count) {
        *found = groups[--count];
      }
    }
  }
  for (int i = 0; i < count; ++i) {
    kill(-groups[i], SIGKILL);
  }
  _exit(0);
}

/// The guard of this process. At a usual end it is waited for, so that it is not left as a zombie where
/// nobody else collects those.
struct RunningGuard {
  int channel = -1;
  pid_t process = -1;
  pid_t owner = -1;  ///< a fork of this process has an end of its own, which it needs another guard for

  ~RunningGuard() {
    if (owner != getpid()) {
      return;
    }
    close(channel);
    constexpr int kTries = 1000, kMicroseconds = 1000;  // forks that still live keep it from ending
    for (int i = 0; i < kTries && waitpid(process, nullptr, WNOHANG) == 0; ++i) {
      usleep(kMicroseconds);
    }
  }
};

void start(RunningGuard& running) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw WorkerFailure(std::string("no pipe can be made: ") + std::strerror(errno));
  }
  const pid_t process = fork();
  if (process < 0) {
    throw WorkerFailure(std::string("no process can be started: ") + std::strerror(errno));
  }
  if (process == 0) {
    guard(ends[0]);
  }
  close(ends[0]);
  running.channel = ends[1];
  running.process = process;
  running.owner = getpid();
}

bool tell(int channel, Record record) {
  ssize_t written = 0;
  do {
    written = write(channel, &record, sizeof record);
  } while (written < 0 && errno == EINTR);
  return written == sizeof record;
}

}  // namespace

int ProcessGuard::getChannel() {
  static std::mutex starting;
  static RunningGuard running;
  const std::lock_guard<std::mutex> lock(starting);
  if (running.owner != getpid()) {
    start(running);
  }
  return running.channel;
}

bool guardGroup(int channel, int leader) {
  return tell(channel, leader);
}

void releaseGroup(int channel, int leader) {
  tell(channel, -leader);
}

}  // namespace twinmap
