#include "framework/simulation/simulator_team.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <stdexcept>

namespace twinmap {
namespace {

std::vector<std::unique_ptr<Simulator>> cloneSerially(const Simulator& prototype, int count) {
  std::vector<std::unique_ptr<Simulator>> clones;
  for (int i = 0; i < count; ++i) {
    clones.push_back(prototype.clone());
  }
  return clones;
}

/// Remembers the first exception of a parallel region, which must not leave it by itself.
class FirstException {
 public:
  bool happened() const { return happened_.load(std::memory_order_relaxed); }
  void keepCurrent() {
    if (!happened_.exchange(true)) {
      exception_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (exception_) {
      std::rethrow_exception(exception_);
    }
  }

 private:
  std::atomic<bool> happened_{false};
  std::exception_ptr exception_;
};

int chooseThreadCount(int threads, int tasks) {
  if (threads < 0) {
    throw std::invalid_argument("runOnTeam: threads must be at least 0");
  }
  return std::max(1, std::min(threads > 0 ? threads : omp_get_max_threads(), tasks));
}

}  // namespace

int countThreads() {
  return omp_in_parallel() ? 1 : omp_get_max_threads();
}

void setThreads(int threads) {
  if (threads > 0) {
    omp_set_num_threads(threads);
  }
}

void runOnTeam(const std::vector<std::unique_ptr<Simulator>>& team, int count, int size,
               const std::function<void(Simulator& simulator, int index)>& task) {
  FirstException failure;
#pragma omp parallel for num_threads(size) schedule(dynamic)
  for (int i = 0; i < count; ++i) {
    if (failure.happened()) {
      continue;
    }
    try {
      task(*team[static_cast<std::size_t>(omp_get_thread_num())], i);
    } catch (...) {
      failure.keepCurrent();
    }
  }
  failure.rethrow();
}

void runOnTeam(const Simulator& prototype, int count, int threads,
               const std::function<void(Simulator& simulator, int index)>& task) {
  const int size = chooseThreadCount(threads, count);
  runOnTeam(cloneSerially(prototype, size), count, size, task);
}

}  // namespace twinmap
