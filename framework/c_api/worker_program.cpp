#include "framework/c_api/worker_program.hpp"

#include <filesystem>

#include "framework/base/files/installed_file.hpp"
#include "framework/base/worker/worker_process.hpp"

namespace twinmap::c_api {
namespace {

namespace fs = std::filesystem;

/// PREFIX/bin/twinmap for PREFIX/lib/libtwinmap.so or PREFIX/lib/PLATFORM/libtwinmap.so.
WorkerCommand findCommand() {
  const fs::path command = findInstalled("bin/twinmap");
  return command.empty() ? WorkerCommand{"/usr/bin/env", {"twinmap"}} : WorkerCommand{command.string(), {}};
}

}  // namespace

void chooseWorkerProgram() {
  static const bool chosen = (setWorkerProgram(findCommand()), true);
  static_cast<void>(chosen);
}

}  // namespace twinmap::c_api
