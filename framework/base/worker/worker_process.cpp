#include "framework/base/worker/worker_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace twinmap {
namespace {

std::mutex choosing_program;
WorkerCommand worker_program{"/proc/self/exe", {}};

/// The files of a process that is to be started, closed at the end.
class SpawnFiles {
 public:
  SpawnFiles() {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
  }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;
  ~SpawnFiles() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }

  pid_t start(const WorkerCommand& command, int channel, int messages) {
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files_, messages, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files_, messages, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&files_, channel, kWorkerChannel);
    std::vector<std::string> words = command.arguments;
    std::string name = command.executable;
    std::vector<char*> arguments{name.data()};
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    pid_t process = -1;
    const int error =
        posix_spawn(&process, command.executable.c_str(), &files_, &attributes_, arguments.data(), environ);
    if (error != 0) {
      throw WorkerFailure(command.executable + " cannot be started: " + std::strerror(error));
    }
    return process;
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

/// File descriptors above those that a child gets, so that none of the copies made for it overwrites another.
int moveUp(int descriptor) {
  constexpr int kFirst = 10;
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, kFirst);
  close(descriptor);
  return moved;
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerCommand& command) {
  int ends[2], pipe[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0 || pipe2(pipe, O_CLOEXEC) != 0) {
    throw WorkerFailure(std::string("no connection to a worker can be made: ") + std::strerror(errno));
  }
  channel_ = moveUp(ends[0]);
  words_.open(moveUp(pipe[0]));
  const int their_channel = moveUp(ends[1]), their_messages = moveUp(pipe[1]);
  fcntl(words_.getFile(), F_SETFL, O_NONBLOCK);
  try {
    process_ = SpawnFiles().start(command, their_channel, their_messages);
  } catch (const WorkerFailure&) {
    close(their_channel);
    close(their_messages);
    close(channel_);
    throw;
  }
  close(their_channel);
  close(their_messages);
}

WorkerProcess::~WorkerProcess() {
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  close(channel_);
}

Frame WorkerProcess::exchange(const Frame& request, double timeout) {
  words_.forget();  // those of the request before
  const Deadline deadline(timeout);
  send(request, deadline);
  std::uint64_t size = 0;
  receive(reinterpret_cast<char*>(&size), sizeof size, deadline);
  Frame answer(size);
  receive(answer.data(), answer.size(), deadline);
  return answer;
}

void WorkerProcess::send(const Frame& request, const Deadline& deadline) {
  const std::uint64_t size = request.size();
  Frame bytes(sizeof size + request.size());
  std::memcpy(bytes.data(), &size, sizeof size);
  std::memcpy(bytes.data() + sizeof size, request.data(), request.size());
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count =
        ::send(channel_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      waitFor(POLLOUT, deadline);
    } else if (errno != EINTR) {
      fail();
    }
  }
}

void WorkerProcess::receive(char* data, std::size_t size, const Deadline& deadline) {
  for (std::size_t received = 0; received < size;) {
    const ssize_t count = recv(channel_, data + received, size - received, MSG_DONTWAIT);
    if (count > 0) {
      received += static_cast<std::size_t>(count);
    } else if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      waitFor(POLLIN, deadline);
    } else if (count == 0 || errno != EINTR) {
      fail();
    }
  }
}

void WorkerProcess::waitFor(short events, const Deadline& deadline) {
  pollfd files[] = {{channel_, events, 0}, {words_.getFile(), POLLIN, 0}};
  const int ready = poll(files, 2, deadline.calcPollTime());
  if (ready > 0 && files[1].revents != 0) {
    words_.read();
  }
  if (ready == 0 && deadline.isOver()) {
    words_.read();
    throw WorkerFailure("the model does not answer within its time" + words_.describe(), true);
  }
}

void WorkerProcess::fail() {
  int status = 0;
  kill(-process_, SIGKILL);  // one that has closed its channel and goes on
  const bool known = waitpid(process_, &status, 0) == process_;
  process_ = -1;
  words_.read();
  throw WorkerFailure((known ? describeEnd("the model's process", status) : "the model's process is gone") +
                      words_.describe());
}

WorkerCommand getWorkerProgram() {
  const char* other = std::getenv("TWINMAP_WORKER");
  if (other != nullptr && *other != '\0') {
    return {other, {}};
  }
  const std::lock_guard<std::mutex> guard(choosing_program);
  return worker_program;
}

void setWorkerProgram(const WorkerCommand& program) {
  const std::lock_guard<std::mutex> guard(choosing_program);
  worker_program = program;
}

}  // namespace twinmap
