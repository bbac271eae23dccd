#include "framework/study/shards/shard_record.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/study/shards/shard_plan.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLost = "it ended without a word: killed, or its node was lost";
constexpr std::array kStates = {ShardState::kMissing, ShardState::kRunning, ShardState::kDone,
                                ShardState::kInterrupted, ShardState::kFailed};

std::string getHost() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const char* node = ::getenv("SLURMD_NODENAME");
  return node != nullptr ? node : host.data();
}

Json writeAttempt(const ShardAttempt& attempt) {
  Json failures = Json::array();
  for (const FailedCase& failure : attempt.failures) {
    failures.push_back({{"case", failure.name}, {"reason", failure.reason}, {"command", failure.command}});
  }
  return {{"host", attempt.host},
          {"state", getName(attempt.state)},
          {"reason", attempt.reason},
          {"failed_cases", failures}};
}

ShardAttempt readAttempt(const Json& entry) {
  ShardAttempt attempt{entry.at("host"), ShardState::kRunning, entry.at("reason"), {}};
  const std::string name = entry.at("state");
  attempt.state =
      *std::find_if(kStates.begin(), kStates.end(), [&](ShardState state) { return name == getName(state); });
  for (const Json& failure : entry.at("failed_cases")) {
    attempt.failures.push_back({failure.at("case"), failure.at("reason"), failure.at("command")});
  }
  return attempt;
}

/// Stopped twice at the same place is a failure too: its reason counts what was done (getReason).
bool isFailure(const ShardAttempt& attempt) {
  return attempt.state != ShardState::kDone;
}

std::string getReason(const ShardAttempt& attempt) {
  return attempt.state == ShardState::kRunning ? kLost : attempt.reason;
}

}  // namespace

const char* getName(ShardState state) {
  constexpr const char* kNames[] = {"missing", "running", "done", "interrupted", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

ShardRecord::ShardRecord(const fs::path& folder, int shard)
    : file_(getClusterFolder(folder) / "shards" / (std::to_string(shard) + ".json")) {
  if (fs::exists(file_)) {
    for (const Json& entry : parseJson(readBytes(file_))) {
      attempts_.push_back(readAttempt(entry));
    }
  }
}

ShardState ShardRecord::getState() const {
  return attempts_.empty() ? ShardState::kMissing : attempts_.back().state;
}

std::string ShardRecord::getRefusal() const {
  if (attempts_.size() < 2) {
    return "";
  }
  const ShardAttempt &last = attempts_.back(), &before = attempts_[attempts_.size() - 2];
  return isFailure(last) && isFailure(before) && getReason(last) == getReason(before) ? getReason(last) : "";
}

std::string ShardRecord::describeLast() const {
  if (attempts_.empty()) {
    return "";
  }
  const ShardAttempt& last = attempts_.back();
  return fmt::format("try {} on {}: {}: {}", attempts_.size(), last.host, getName(last.state),
                     getReason(last));
}

void ShardRecord::begin() {
  attempts_.push_back({getHost(), ShardState::kRunning, "", {}});
  write();
}

void ShardRecord::end(ShardState state, const std::string& reason, const std::vector<FailedCase>& failures) {
  attempts_.back().state = state;
  attempts_.back().reason = reason;
  attempts_.back().failures = failures;
  write();
}

void ShardRecord::write() const {
  Json entries = Json::array();
  for (const ShardAttempt& attempt : attempts_) {
    entries.push_back(writeAttempt(attempt));
  }
  makeFolders(file_.parent_path());
  writeTextFile(file_, formatJson(entries, 1) + "\n");
}

}  // namespace twinmap
