#pragma once

namespace twinmap {

/// A small process that outlives this one by a moment: it knows the process groups of the workers, and kills
/// those that are left when this process has ended, in whatever way (kill -9 included).
class ProcessGuard {
 public:
  /// The end of a pipe that guardGroup() and releaseGroup() write to; starts the guard at the first call.
  /// Throws WorkerFailure if it cannot be started. From any thread.
  static int getChannel();
};

/// The process group `leader` is to be killed when this process ends. Async-signal-safe, so that a worker
/// says it of itself before anything of it runs. False if the guard is gone.
bool guardGroup(int channel, int leader);

/// Before the leader is waited for: its number may then be another's.
void releaseGroup(int channel, int leader);

}  // namespace twinmap
