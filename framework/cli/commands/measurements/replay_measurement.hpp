#pragma once

#include "framework/cli/commands/commands.hpp"
#include "framework/study/replay/replay.hpp"

namespace twinmap::cli {

/// What replay shows: the measurement beside the model that it updates, which is asked what it lacks. Throws
/// as replay and infer do.
Replay replayMeasurement(const InferenceSource& source, const ReplayArguments& arguments);

}  // namespace twinmap::cli
