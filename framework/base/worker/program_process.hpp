#pragma once

#include <sys/types.h>

#include <string>

#include "framework/base/worker/deadline.hpp"
#include "framework/base/worker/output_tail.hpp"
#include "framework/base/worker/start_program.hpp"
#include "framework/base/worker/worker_process.hpp"

namespace twinmap {

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
