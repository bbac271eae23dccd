#pragma once

#include <string>

#include "framework/report/figure.hpp"
#include "framework/study/replay/replay.hpp"

namespace twinmap {

/// One self-contained page: the trust status, the parameters, how well each output is followed, and measured,
/// nominal and updated responses with their residuals.
std::string makeReplayPage(const MeasurementReader& reader, const Replay& replay);

/// Its chapters, for a page of several: `prefix` begins the names of chapters and tables ("1-").
void addReplay(const MeasurementReader& reader, const Replay& replay, const std::string& prefix, Page& page);

}  // namespace twinmap
