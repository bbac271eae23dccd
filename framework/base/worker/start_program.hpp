#pragma once

#include <sys/types.h>

#include "framework/base/worker/program_process.hpp"

namespace twinmap {

/// A program that has been started, and this side's ends of its pipes.
struct StartedProgram {
  pid_t process;
  int input, output, messages;  ///< to write; to read, non-blocking
};

/// Starts a program as the leader of a group that `guard` (ProcessGuard) knows. Throws WorkerFailure where
/// that is not possible, with the reason.
StartedProgram startProgram(const ProgramStart& start, int guard);

}  // namespace twinmap
