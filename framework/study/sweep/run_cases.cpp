#include "framework/study/sweep/run_cases.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <numeric>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/log/run_control.hpp"

namespace twinmap {
namespace {

class CaseRunner {
 public:
  CaseRunner(std::size_t cases, const CaseScheduling& scheduling, const std::function<void(int, int)>& task)
      : outcomes(cases), scheduling_(scheduling), task_(task) {}

  void run(int index, int threads) {
    if (mayBegin()) {
      try {
        note(index, runTask(index, threads));
      } catch (...) {
        const std::lock_guard<std::mutex> guard(mutex_);
        fatal_ = fatal_ ? fatal_ : std::current_exception();
        ended_ = true;
      }
    }
  }

  void rethrow() const {
    if (fatal_) {
      std::rethrow_exception(fatal_);
    }
  }

  std::vector<CaseOutcome> outcomes;

 private:
  bool mayBegin() const {
    return !ended_ && (scheduling_.stop == nullptr || !scheduling_.stop->load(std::memory_order_relaxed));
  }

  void note(int index, const CaseOutcome& outcome) {
    if (scheduling_.fail_fast && outcome.status == CaseStatus::kFailed) {
      ended_ = true;
    }
    const std::lock_guard<std::mutex> guard(mutex_);
    outcomes[index] = outcome;
    if (scheduling_.finished && outcome.status != CaseStatus::kMissing) {
      scheduling_.finished(index, outcome);
    }
  }

  CaseOutcome runTask(int index, int threads) const {
    try {
      task_(index, threads);
      return {CaseStatus::kDone, ""};
    } catch (const DiskFull&) {
      throw;
    } catch (const Interrupted&) {
      return {CaseStatus::kMissing, ""};
    } catch (const std::exception& error) {
      return {CaseStatus::kFailed, error.what()};
    }
  }

  const CaseScheduling& scheduling_;
  const std::function<void(int, int)>& task_;
  std::mutex mutex_;
  std::atomic<bool> ended_{false};  ///< no other case is begun
  std::exception_ptr fatal_;
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
  runner.rethrow();
  return std::move(runner.outcomes);
}

}  // namespace twinmap
