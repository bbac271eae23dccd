#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "framework/base/worker/deadline.hpp"
#include "framework/base/worker/output_tail.hpp"
#include "framework/base/worker/worker_process.hpp"

namespace twinmap {

/// How a program is started.
struct ProgramStart {
  std::vector<std::string> command;  ///< the program, searched in PATH, and its arguments
  std::string folder;                ///< where it runs; "": here
  std::vector<std::pair<std::string, std::string>> environment{};  ///< beside this process's own
  double memory = 0.0;                                             ///< GiB of address space; 0: no limit
};

/// A program that has been started, and this side's ends of its pipes.
struct StartedProgram {
  pid_t process;
  int input, output, messages;  ///< to write; to read, non-blocking
};

/// Starts a program as the leader of a group that `guard` (ProcessGuard) knows. Throws WorkerFailure where
/// that is not possible, with the reason.
StartedProgram startProgram(const ProgramStart& start, int guard);

/// A program that answers lines of text on its standard output to lines on its standard input. It has a
/// process group of its own, which ends with this value, or with this process in whatever way that ends. What
/// it writes to its standard error, and lines of its output that do not begin with '{', are messages, whose
/// last are kept for the reason of a failure. Not thread safe.
class ProgramProcess {
 public:
  /// Throws WorkerFailure if the program cannot be started. Cost: that of a fork.
  explicit ProgramProcess(const ProgramStart& start);
  ProgramProcess(const ProgramProcess&) = delete;
  ProgramProcess& operator=(const ProgramProcess&) = delete;
  /// Kills the program and all of its group, and waits for its end.
  ~ProgramProcess();

  /// Sends `request`, a line without its end, and waits `timeout` (s) for a line back. Throws WorkerFailure
  /// with how the program ended and what it said last; it is then not to be used any more. Cost: some 15 us
  /// beside the program's own.
  std::string exchange(const std::string& request, double timeout);

  /// Bytes in memory; 0 where that is not known.
  double getResidentSize() const;

 private:
  void wait(bool sending, const Deadline& deadline);
  void readAnswer();
  bool takeLine(std::string& line);
  [[noreturn]] void fail();
  void keepRest();
  void end(int* status);

  int input_ = -1, output_ = -1;
  int guard_ = -1;
  pid_t process_ = -1;
  OutputTail words_;
  std::string received_;
  bool answered_ = false;  ///< once
};

}  // namespace twinmap
