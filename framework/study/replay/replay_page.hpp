#pragma once

#include <string>

#include "framework/study/replay/replay.hpp"

namespace twinmap {

/// One self-contained page: the trust status, the parameters, how well each output is followed, and measured,
/// nominal and updated responses with their residuals.
std::string makeReplayPage(const Inferrer& inferrer, const Replay& replay);

}  // namespace twinmap
