
#include <mutex>

#include "framework/base/log/log.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/interruptible.hpp"
#include "framework/python/python_experiment.hpp"
#include "framework/study/pipeline/require_model.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/sweep/case_cost.hpp"
#include "framework/study/sweep/run_sweep.hpp"

namespace twinmap::python {
namespace {

namespace nb = nanobind;

/// How a run is to be done.
struct Request {
  std::string folder, store, command;
  int threads = 1;
  double memory = 0.0;  ///< GiB that a sweep may take; 0: half of the machine's
};

/// The latest progress, on its way from the run's threads to Python's.
class ProgressMailbox {
 public:
  void put(const Progress& progress) {
    const std::lock_guard<std::mutex> lock(mutex_);
    latest_ = progress;
  }
  std::optional<Progress> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(latest_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<Progress> latest_;
};

/// Runs of one process take turns: each has the log and all cores.
class Turn {
 public:
  /// Throws Interrupted if `stop` is set before the turn comes.
  explicit Turn(const std::atomic<bool>& stop) {
    constexpr std::chrono::milliseconds kPeriod(20);
    while (!mutex().try_lock_for(kPeriod)) {
      if (stop) {
        throw Interrupted("interrupted, before it began");
      }
    }
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() { mutex().unlock(); }

 private:
  static std::timed_mutex& mutex() {
    static std::timed_mutex turns;
    return turns;
  }
};

/// The log goes to run.log alone. Once, as a run of another thread may be logging.
void setUpLog() {
  static const bool done = (logToRunsOnly(), true);
  static_cast<void>(done);
}

/// Does `work`, which obeys the control, with progress to a Python function (or none).
void runWithProgress(int threads, const std::function<void(const Progress&)>& progress,
                     const std::function<void(const RunControl&)>& work) {
  std::atomic<bool> stop{false};
  ProgressMailbox mailbox;
  RunControl control{threads, &stop, &stop, nullptr};
  if (progress) {
    control.progress = [&mailbox](const Progress& latest) { mailbox.put(latest); };
  }
  runInterruptibly(
      [&] {
        const Turn turn(stop);
        setUpLog();
        work(control);
      },
      stop,
      [&] {
        if (const std::optional<Progress> latest = mailbox.take()) {
          progress(*latest);
        }
      });
}

void run(const PythonExperiment& experiment, const Request& request,
         const std::function<void(const Progress&)>& progress) {
  runWithProgress(request.threads, progress, [&](const RunControl& control) {
    const ExperimentSpec spec = reduceLongRecord(experiment.getSpec());
    requireMemory(spec, request.threads, getAvailableMemory());
    requireModel(spec);
    RunOptions options;
    options.folder = request.folder;
    options.store = request.store;
    options.command = request.command;
    runExperiment(spec, options, control);
  });
}

/// Cases, of them complete, and the names and reasons of those that failed.
nb::tuple sweep(const PythonExperiment& experiment, const Request& request,
                const std::function<void(const Progress&)>& progress) {
  SweepResult result;
  runWithProgress(request.threads, progress, [&](const RunControl& control) {
    constexpr double kShare = 0.5;
    SweepOptions options;
    options.folder = request.folder;
    options.store = request.store;
    options.most_memory = std::max(getAvailableMemory(), request.memory * kGibibyte);
    options.memory = request.memory > 0.0 ? request.memory * kGibibyte : kShare * getMachineMemory();
    options.command = request.command;
    result = runSweep(experiment.getTree(), options, control);
  });
  std::vector<std::pair<std::string, std::string>> failures;
  for (const FailedCase& failure : result.failures) {
    failures.emplace_back(failure.name, failure.reason);
  }
  return nb::make_tuple(result.cases, result.complete, failures);
}

}  // namespace

void bindRuns(nb::module_& module) {
  nb::class_<Progress>(module, "Progress", "How far a stage of a run is")
      .def_ro("stage", &Progress::stage)
      .def_ro("done", &Progress::done)
      .def_ro("total", &Progress::total)
      .def_ro("failed", &Progress::failed)
      .def_ro("work", &Progress::work);
  nb::class_<Request>(module, "RunRequest")
      .def(nb::init<>())
      .def_rw("folder", &Request::folder)
      .def_rw("store", &Request::store)
      .def_rw("command", &Request::command)
      .def_rw("threads", &Request::threads)
      .def_rw("memory", &Request::memory);
  module.def("run", &run, nb::arg("experiment"), nb::arg("request"), nb::arg("progress") = nb::none());
  module.def("sweep", &sweep, nb::arg("experiment"), nb::arg("request"), nb::arg("progress") = nb::none());
}

}  // namespace twinmap::python
