#include "framework/c_api/worker_program.hpp"

#include <dlfcn.h>

#include <filesystem>

#include "framework/base/worker/worker_process.hpp"

namespace twinmap::c_api {
namespace {

namespace fs = std::filesystem;

/// The folder of this library; "" where that is not known.
fs::path findLibraryFolder() {
  static const char kHere = 0;
  Dl_info info{};
  return dladdr(&kHere, &info) != 0 && info.dli_fname != nullptr ? fs::path(info.dli_fname).parent_path()
                                                                 : fs::path();
}

/// PREFIX/bin/twinmap for PREFIX/lib/libtwinmap.so or PREFIX/lib/PLATFORM/libtwinmap.so.
WorkerCommand findCommand() {
  std::error_code failure;
  for (fs::path folder = findLibraryFolder(); folder.has_relative_path(); folder = folder.parent_path()) {
    const fs::path command = folder / "bin" / "twinmap";
    if (fs::is_regular_file(command, failure)) {
      return {command.string(), {}};
    }
  }
  return {"/usr/bin/env", {"twinmap"}};
}

}  // namespace

void chooseWorkerProgram() {
  static const bool chosen = (setWorkerProgram(findCommand()), true);
  static_cast<void>(chosen);
}

}  // namespace twinmap::c_api
