#include "framework/python/interruptible.hpp"

#include <nanobind/nanobind.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace twinmap::python {
namespace {

namespace nb = nanobind;

/// Work under way on a thread of its own.
class Worker {
 public:
  explicit Worker(const std::function<void()>& work) : thread_([this, &work] { run(work); }) {}
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() { thread_.join(); }

  /// Whether it has ended, after `longest` at the most.
  bool waitFor(std::chrono::milliseconds longest) {
    std::unique_lock<std::mutex> lock(mutex_);
    return ending_.wait_for(lock, longest, [this] { return ended_; });
  }

  /// What it has thrown.
  const std::exception_ptr& getFailure() const { return failure_; }

 private:
  void run(const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    ending_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // the last member: it uses the others
};

std::exception_ptr lookForInterruption(const std::function<void()>& tick) {
  try {
    if (PyErr_CheckSignals() != 0) {
      throw nb::python_error();
    }
    if (tick) {
      tick();
    }
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

void runInterruptibly(const std::function<void()>& work, std::atomic<bool>& stop,
                      const std::function<void()>& tick) {
  constexpr std::chrono::milliseconds kPeriod(50);
  std::exception_ptr interruption;
  Worker worker(work);
  for (bool ended = false; !ended;) {
    {
      const nb::gil_scoped_release release;
      ended = worker.waitFor(kPeriod);
    }
    if (!interruption) {
      interruption = lookForInterruption(tick);
      stop = stop || interruption != nullptr;
    }
  }
  if (interruption) {
    std::rethrow_exception(interruption);
  }
  if (worker.getFailure()) {
    std::rethrow_exception(worker.getFailure());
  }
}

}  // namespace twinmap::python
