#pragma once

#include <atomic>

namespace twinmap::cli {

/// What signals have asked for.
struct StopFlags {
  const std::atomic<bool>& stop;     ///< by SIGINT or SIGTERM
  const std::atomic<bool>& abandon;  ///< by SIGTERM: whoever sends it will not wait for a training to end
};

/// From now on SIGINT and SIGTERM ask to stop: the first sets its flags and says so on stderr; the second
/// ends the process at once, with 128 + the signal's number, as a shell reports it.
StopFlags catchSignals();

/// Whether SIGINT and SIGTERM only set getSignal() from now on, for a thread that looks at it; the second
/// ends the process at once. Else they end it, as ever.
void watchInterrupt(bool watched);

/// The number of the signal that came, or 0.
int getSignal();

}  // namespace twinmap::cli
