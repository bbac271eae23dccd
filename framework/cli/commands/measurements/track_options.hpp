#pragma once

#include "framework/cli/commands/commands.hpp"
#include "framework/tracking/track_session.hpp"

namespace twinmap::cli {

/// What a command asks of the twin in time. Throws ExperimentError where its file has no section `tracking:`.
TrackOptions makeTrackOptions(const TwinArguments& arguments);

}  // namespace twinmap::cli
