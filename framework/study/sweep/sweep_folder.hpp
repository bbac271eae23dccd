#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/experiment/files/sweep_cases.hpp"

namespace twinmap {

/// A case that could not be run.
struct FailedCase {
  std::string name;
  std::string reason;
  std::string command;  ///< runs it alone
};

std::filesystem::path getCaseFolder(const std::filesystem::path& sweep, const SweepCase& sweep_case);

/// One for each case: whether its folder is complete.
std::vector<bool> findComplete(const std::filesystem::path& sweep, const std::vector<SweepCase>& cases);

/// "twinmap run .../resolved.yaml --out ... --store ...", as a shell takes it.
std::string makeCaseCommand(const std::filesystem::path& case_folder, const std::filesystem::path& store);

/// DIR/failed_cases.csv: case, reason, command.
void writeFailedCases(const std::filesystem::path& sweep, const std::vector<FailedCase>& failures);
/// The names in it; none if there is no such file.
std::vector<std::string> readFailedCases(const std::filesystem::path& sweep);

}  // namespace twinmap
