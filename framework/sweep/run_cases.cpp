#include "framework/sweep/run_cases.hpp"

#include <algorithm>
#include <mutex>
#include <numeric>

namespace twinmap {
namespace {

class CaseRunner {
 public:
  CaseRunner(std::size_t cases, const CaseScheduling& scheduling, const std::function<void(int, int)>& task)
      : outcomes(cases), scheduling_(scheduling), task_(task) {}

  void run(int index, int threads) {
    const bool stopped = scheduling_.stop != nullptr && scheduling_.stop->load(std::memory_order_relaxed);
    if (stopped || (scheduling_.fail_fast && failed_.load(std::memory_order_relaxed))) {
      return;
    }
    const CaseOutcome outcome = runTask(index, threads);
    failed_ = failed_ || outcome.status == CaseStatus::kFailed;
    const std::lock_guard<std::mutex> guard(mutex_);
    outcomes[index] = outcome;
    if (scheduling_.finished) {
      scheduling_.finished(index, outcome);
    }
  }

  std::vector<CaseOutcome> outcomes;

 private:
  CaseOutcome runTask(int index, int threads) const {
    try {
      task_(index, threads);
      return {CaseStatus::kDone, ""};
    } catch (const std::exception& error) {
      return {CaseStatus::kFailed, error.what()};
    }
  }

  const CaseScheduling& scheduling_;
  const std::function<void(int, int)>& task_;
  std::mutex mutex_;
  std::atomic<bool> failed_{false};
};

/// Indices by decreasing work.
std::vector<int> sortByWork(const std::vector<CaseCost>& costs) {
  std::vector<int> order(costs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return costs[a].flops > costs[b].flops; });
  return order;
}

}  // namespace

std::vector<CaseOutcome> runCases(const std::vector<CaseCost>& costs, const CaseScheduling& scheduling,
                                  const std::function<void(int index, int threads)>& task) {
  CaseRunner runner(costs.size(), scheduling, task);
  std::vector<int> order = sortByWork(costs);
  const double share = scheduling.memory / scheduling.threads;
  const auto small = std::stable_partition(order.begin(), order.end(),
                                           [&](int index) { return costs[index].bytes > share; });
  for (auto large = order.begin(); large != small; ++large) {
    runner.run(*large, scheduling.threads);
  }
  const std::vector<int> rest(small, order.end());
  const int count = static_cast<int>(rest.size());
#pragma omp parallel for num_threads(scheduling.threads) schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) {
    runner.run(rest[i], 1);
  }
  return std::move(runner.outcomes);
}

}  // namespace twinmap
