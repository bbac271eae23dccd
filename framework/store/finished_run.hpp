#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace twinmap {

/// Throws ExperimentError naming the folder and what it lacks, unless a run was finished there and left
/// `files`. Of a sweep the error names a case.
void requireFinishedRun(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// The folders of a sweep's cases, `folder`/cases/NAME, sorted by name; none if it is not a sweep.
std::vector<std::filesystem::path> listCases(const std::filesystem::path& folder);

}  // namespace twinmap
