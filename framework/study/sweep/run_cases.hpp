#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "framework/study/sweep/case_cost.hpp"

namespace twinmap {

enum class CaseStatus { kMissing, kDone, kFailed };

struct CaseOutcome {
  CaseStatus status = CaseStatus::kMissing;
  std::string reason;  ///< of a failure
};

struct CaseScheduling {
  int threads = 1;
  double memory = 0.0;                      ///< bytes that the cases may need together
  bool fail_fast = false;                   ///< no case is begun after one has failed
  const std::atomic<bool>* stop = nullptr;  ///< once true, no case is begun
  /// Called after each case, one call at a time.
  std::function<void(int index, const CaseOutcome& outcome)> finished;
};

/// Runs task(index, threads) for every index of `costs`: first the cases that need more than their share of
/// the memory, one after the other with all threads; then the others, each on one thread of a team, the most
/// work first. An exception of a task is the case's failure, Interrupted
/// leaves it missing; but after a DiskFull, or an exception of
/// `finished`, no case is begun, and it is thrown again when those under way have ended.
std::vector<CaseOutcome> runCases(const std::vector<CaseCost>& costs, const CaseScheduling& scheduling,
                                  const std::function<void(int index, int threads)>& task);

}  // namespace twinmap
