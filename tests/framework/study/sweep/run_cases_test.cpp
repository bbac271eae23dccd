#include "framework/study/sweep/run_cases.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <mutex>
#include <stdexcept>
#include <thread>

#include "framework/base/files/atomic_file.hpp"

namespace twinmap {
namespace {

/// Runs cases that note their order, and how many run at once with how much memory.
struct Recorder {
  std::vector<CaseCost> costs;
  std::mutex mutex;
  std::vector<int> order, threads_of;
  double bytes = 0.0, most_bytes = 0.0;

  explicit Recorder(std::vector<CaseCost> of) : costs(std::move(of)), threads_of(costs.size()) {}

  void operator()(int index, int threads) {
    begin(index, threads);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const std::lock_guard<std::mutex> guard(mutex);
    bytes -= costs[index].bytes;
  }

  void begin(int index, int threads) {
    const std::lock_guard<std::mutex> guard(mutex);
    order.push_back(index);
    threads_of[index] = threads;
    bytes += costs[index].bytes;
    most_bytes = std::max(most_bytes, bytes);
  }
};

TEST(RunCases, MostWorkFirst) {
  Recorder recorder({{1, 5}, {1, 20}, {1, 10}});
  const auto outcomes = runCases(recorder.costs, {1, 100.0, false, nullptr, {}},
                                 [&](int i, int threads) { recorder(i, threads); });
  EXPECT_EQ(recorder.order, (std::vector<int>{1, 2, 0}));
  for (const CaseOutcome& outcome : outcomes) {
    EXPECT_EQ(outcome.status, CaseStatus::kDone);
  }
}

TEST(RunCases, CasesAboveTheirShareRunAloneWithAllThreadsAndTheMemoryIsKept) {
  std::vector<CaseCost> costs;
  for (int i = 0; i < 40; ++i) {
    costs.push_back({i % 10 == 0 ? 30.0 : 25.0, double(i)});
  }
  Recorder recorder(costs);
  runCases(costs, {4, 100.0, false, nullptr, {}}, [&](int i, int threads) { recorder(i, threads); });
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(recorder.threads_of[i], i % 10 == 0 ? 4 : 1);
  }
  EXPECT_EQ(std::vector<int>(recorder.order.begin(), recorder.order.begin() + 4),
            (std::vector<int>{30, 20, 10, 0}));
  EXPECT_LE(recorder.most_bytes, 100.0);
}

TEST(RunCases, AFailureIsReportedAndStopsTheOthersOnlyIfAsked) {
  const auto task = [](int index, int) {
    if (index == 1) {
      throw std::runtime_error("no luck");
    }
  };
  const std::vector<CaseCost> costs{{1, 1}, {1, 3}, {1, 2}};
  const auto count = [](const std::vector<CaseOutcome>& outcomes, CaseStatus status) {
    return std::count_if(outcomes.begin(), outcomes.end(), [&](const auto& o) { return o.status == status; });
  };
  const auto going = runCases(costs, {2, 100.0, false, nullptr, {}}, task);
  EXPECT_EQ(going[1].reason, "no luck");
  EXPECT_EQ(count(going, CaseStatus::kDone), 2);
  const auto failed = runCases(costs, {1, 100.0, true, nullptr, {}}, task);
  EXPECT_EQ(failed[1].status, CaseStatus::kFailed);
  EXPECT_EQ(count(failed, CaseStatus::kMissing), 2);
}

TEST(RunCases, AFullDiskOrAnErrorOutsideOfTheCasesEndsThem) {
  std::atomic<int> begun{0};
  const std::vector<CaseCost> costs(6, {1, 1});
  const auto fill_disk = [&](int, int) {
    ++begun;
    throw DiskFull("no space");
  };
  EXPECT_THROW(runCases(costs, {2, 100.0, false, nullptr, {}}, fill_disk), DiskFull);
  EXPECT_LE(begun, 2);
  CaseScheduling scheduling{2, 100.0, false, nullptr, {}};
  scheduling.finished = [](int, const CaseOutcome&) { throw std::runtime_error("cannot be noted"); };
  EXPECT_THROW(runCases(costs, scheduling, [](int, int) {}), std::runtime_error);
}

TEST(RunCases, AStopFinishesTheCasesUnderWayAndBeginsNoOther) {
  std::atomic<bool> stop{false};
  int finished = 0;
  CaseScheduling scheduling{1, 100.0, false, &stop, {}};
  scheduling.finished = [&](int, const CaseOutcome& outcome) {
    finished += outcome.status == CaseStatus::kDone ? 1 : 0;
  };
  const auto outcomes =
      runCases({{1, 3}, {1, 2}, {1, 1}}, scheduling, [&](int index, int) { stop = index == 1; });
  EXPECT_EQ(finished, 2);
  EXPECT_EQ(outcomes[2].status, CaseStatus::kMissing);
}

}  // namespace
}  // namespace twinmap
