#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

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

}  // namespace twinmap
