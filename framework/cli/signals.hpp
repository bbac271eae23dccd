#pragma once

#include <atomic>

namespace twinmap::cli {

/// From now on SIGINT and SIGTERM ask to stop: the first sets the flag and says so on stderr; the second ends
/// the process at once, with 128 + the signal's number, as a shell reports it.
const std::atomic<bool>& catchSignals();

/// The number of the signal that came, or 0.
int getSignal();

}  // namespace twinmap::cli
