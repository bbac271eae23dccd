#include "framework/process/worker_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace twinmap {
namespace {

double getTime() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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

std::string describeEnd(int status) {
  if (WIFSIGNALED(status)) {
    return "the model's process crashed: " + std::string(strsignal(WTERMSIG(status)));
  }
  return "the model's process ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerCommand& command) {
  int ends[2], pipe[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0 || pipe2(pipe, O_CLOEXEC) != 0) {
    throw WorkerFailure(std::string("no connection to a worker can be made: ") + std::strerror(errno));
  }
  channel_ = moveUp(ends[0]);
  messages_ = moveUp(pipe[0]);
  const int their_channel = moveUp(ends[1]), their_messages = moveUp(pipe[1]);
  fcntl(messages_, F_SETFL, O_NONBLOCK);
  try {
    process_ = SpawnFiles().start(command, their_channel, their_messages);
  } catch (const WorkerFailure&) {
    close(their_channel);
    close(their_messages);
    close(channel_);
    close(messages_);
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
  close(messages_);
}

Frame WorkerProcess::exchange(const Frame& request, double timeout) {
  const double deadline = getTime() + timeout;
  send(request, deadline);
  std::uint64_t size = 0;
  receive(reinterpret_cast<char*>(&size), sizeof size, deadline);
  Frame answer(size);
  receive(answer.data(), answer.size(), deadline);
  return answer;
}

void WorkerProcess::send(const Frame& request, double deadline) {
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

void WorkerProcess::receive(char* data, std::size_t size, double deadline) {
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

void WorkerProcess::waitFor(short events, double deadline) {
  pollfd files[] = {{channel_, events, 0}, {messages_, POLLIN, 0}};
  const double left = deadline - getTime();
  constexpr double kLongest = 1e9;  // ms; what an int holds
  const int wait = static_cast<int>(std::ceil(std::min(std::max(1000.0 * left, 0.0), kLongest)));
  const int ready = poll(files, (files[1].fd >= 0) ? 2 : 1, wait);
  if (ready > 0 && files[1].revents != 0) {
    readMessages();
  }
  if (ready == 0 && getTime() >= deadline) {
    readMessages();
    throw WorkerFailure("the model does not answer within its time" + last_words_, true);
  }
}

void WorkerProcess::readMessages() {
  constexpr std::size_t kMostKept = 1000;  // characters: what people read of it
  char buffer[4096];
  ssize_t count = 0;
  while (messages_ >= 0 && (count = read(messages_, buffer, sizeof buffer)) > 0) {
    last_words_.append(buffer, static_cast<std::size_t>(count));
    if (last_words_.size() > kMostKept) {
      last_words_.erase(0, last_words_.size() - kMostKept);
    }
  }
  if (count == 0 && messages_ >= 0) {  // closed; poll would report it again and again
    close(messages_);
    messages_ = -1;
  }
}

void WorkerProcess::fail() {
  int status = 0;
  kill(-process_, SIGKILL);  // one that has closed its channel and goes on
  const bool known = waitpid(process_, &status, 0) == process_;
  process_ = -1;
  readMessages();
  const std::size_t end = last_words_.find_last_not_of(" \n\r\t");
  const std::string words = end == std::string::npos ? "" : "; it said: " + last_words_.substr(0, end + 1);
  throw WorkerFailure((known ? describeEnd(status) : std::string("the model's process is gone")) + words);
}

std::string getWorkerExecutable() {
  const char* other = std::getenv("TWINMAP_WORKER");
  return other != nullptr && *other != '\0' ? other : "/proc/self/exe";
}

}  // namespace twinmap
