#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace twinmap {

/// Runs a program, searched in PATH, with its arguments in a folder to its end. It reads nothing; what it
/// says goes into the file `log`. Returns its exit status; -1 where it cannot be started, 128 where a signal
/// ended it.
int runProgram(const std::vector<std::string>& command, const std::filesystem::path& folder,
               const std::filesystem::path& log);

}  // namespace twinmap
