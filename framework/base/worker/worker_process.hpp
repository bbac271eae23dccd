#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "framework/base/worker/deadline.hpp"
#include "framework/base/worker/output_tail.hpp"

namespace twinmap {

/// A worker crashed, ended, did not answer in time, or could not be started.
class WorkerFailure : public std::runtime_error {
 public:
  explicit WorkerFailure(const std::string& reason, bool timed_out = false)
      : std::runtime_error(reason), timed_out_(timed_out) {}

  bool hasTimedOut() const { return timed_out_; }

 private:
  bool timed_out_;
};

/// How a worker is started.
struct WorkerCommand {
  std::string executable;
  std::vector<std::string> arguments;
};

using Frame = std::vector<char>;

/// A process that answers frames of bytes, one by one, on its file descriptor kWorkerChannel; serveFrames()
/// is its side. It has a process group of its own, nothing on its standard input, and what it writes to its
/// outputs is kept, the last of it, for the reason of a failure. It ends with this value, and by itself when
/// this process is gone. Not thread safe.
class WorkerProcess {
 public:
  /// Throws WorkerFailure if it cannot be started.
  explicit WorkerProcess(const WorkerCommand& command);
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;
  /// Kills the process and all of its group, and waits for its end.
  ~WorkerProcess();

  /// Sends a request and waits `timeout` (s) for the answer. Throws WorkerFailure with how the worker ended
  /// and what it said last; it is then not to be used any more. Cost: some 10 us beside the worker's own.
  Frame exchange(const Frame& request, double timeout);

 private:
  void send(const Frame& request, const Deadline& deadline);
  void receive(char* data, std::size_t size, const Deadline& deadline);
  void waitFor(short events, const Deadline& deadline);
  [[noreturn]] void fail();

  int channel_ = -1;
  pid_t process_ = -1;
  OutputTail words_;
};

constexpr int kWorkerChannel = 3;

/// The program that workers are processes of, with the arguments that come before theirs: this program
/// itself, whatever became of its file, or what setWorkerProgram() said; TWINMAP_WORKER names another in any
/// case.
WorkerCommand getWorkerProgram();

/// For programs that are not twinmap, such as those that use it as a library. From any thread.
void setWorkerProgram(const WorkerCommand& program);

}  // namespace twinmap
