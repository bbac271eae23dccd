#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/study/sweep/sweep_folder.hpp"

namespace twinmap {

enum class ShardState { kMissing, kRunning, kDone, kInterrupted, kFailed };

/// "missing", "running", "done", "interrupted", "failed".
const char* getName(ShardState state);

/// One try of a shard; as long as it has not ended it counts as running, and as lost once another begins.
struct ShardAttempt {
  std::string host;
  ShardState state = ShardState::kRunning;
  std::string reason;                ///< of a failure
  std::vector<FailedCase> failures;  ///< cases
};

/// What has become of a shard: DIR/cluster/shards/N.json, written whole by the process that has the shard.
class ShardRecord {
 public:
  /// Reads it; no file is a shard that nobody has begun.
  ShardRecord(const std::filesystem::path& folder, int shard);

  ShardState getState() const;
  const std::vector<ShardAttempt>& getAttempts() const { return attempts_; }
  /// Why it is not to be tried again: the last two attempts failed, or were lost, for the same reason, or
  /// were stopped without having done anything in between. Empty if it is.
  std::string getRefusal() const;
  /// "try 2 on n1: failed: REASON"; empty where nobody has begun. One that counts as running may be lost.
  std::string describeLast() const;

  void begin();
  void end(ShardState state, const std::string& reason = "", const std::vector<FailedCase>& failures = {});

 private:
  void write() const;

  std::filesystem::path file_;
  std::vector<ShardAttempt> attempts_;
};

}  // namespace twinmap
