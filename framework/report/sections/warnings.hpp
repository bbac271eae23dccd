#pragma once

#include <string>
#include <vector>

#include "framework/results/run_folder.hpp"

namespace twinmap {

/// What a person should know before trusting a run, each with what to do about it.
std::vector<std::string> collectWarnings(const RunFolder& run);

}  // namespace twinmap
