#pragma once

#include <filesystem>
#include <string>

#include "framework/base/log/run_control.hpp"

namespace twinmap {

/// Does shard `shard` of what was submitted in `folder`: simulates what is missing of its samples, trains and
/// evaluates its cases, or writes the tables of the sweep. One that was done before is left alone; one that
/// failed twice for the same reason is not tried again. Returns what was done, human-readable. Throws
/// Interrupted when `control` stops it, after what was under way is saved; ExperimentError for a folder that
/// was not submitted, a shard that it does not have, and a build or machine that computes other bits than the
/// one that it was submitted with; std::runtime_error for cases that failed.
std::string runShard(const std::filesystem::path& folder, int shard, const std::string& command,
                     const RunControl& control);

}  // namespace twinmap
