#include "framework/simulation/sample_generator.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>

namespace twinmap {
namespace {

Trajectories prepare(const Simulator& prototype, const Eigen::MatrixXd& parameters) {
  Trajectories result;
  result.parameters = parameters;
  result.times = prototype.getTimes();
  result.output_names = prototype.getOutputNames();
  result.output_units = prototype.getOutputUnits();
  const Eigen::Index rows = static_cast<Eigen::Index>(result.output_names.size()) * result.times.size();
  result.responses.setConstant(rows, parameters.cols(), std::numeric_limits<double>::quiet_NaN());
  result.statuses.resize(parameters.cols());
  return result;
}

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

/// Reports the number of samples done, one report at a time.
class Progress {
 public:
  explicit Progress(const GeneratorOptions& options) : report_(options.progress) {}

  void add(int count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ += count;
    if (report_) {
      report_(done_);
    }
  }

 private:
  const std::function<void(int)>& report_;
  std::mutex mutex_;
  int done_ = 0;
};

void simulateBatch(Simulator& simulator, int first, int count, Trajectories& result) {
  simulator.simulate(result.parameters.middleCols(first, count), result.responses.middleCols(first, count),
                     &result.statuses[first]);
}

int chooseThreadCount(const GeneratorOptions& options, int batches) {
  const int wanted = options.threads > 0 ? options.threads : omp_get_max_threads();
  return std::max(1, std::min(wanted, batches));
}

void check(const GeneratorOptions& options) {
  if (options.batch_size < 1 || options.threads < 0) {
    throw std::invalid_argument("generateSamples: batch_size must be at least 1 and threads at least 0");
  }
}

}  // namespace

int Trajectories::calcFailureCount() const {
  return static_cast<int>(
      std::count_if(statuses.begin(), statuses.end(), [](const SampleStatus& status) { return !status.ok; }));
}

Trajectories generateSamples(const Simulator& prototype, const Eigen::MatrixXd& parameters,
                             const GeneratorOptions& options) {
  check(options);
  Trajectories result = prepare(prototype, parameters);
  const int samples = result.getSampleCount();
  const int batches = (samples + options.batch_size - 1) / options.batch_size;
  const int threads = chooseThreadCount(options, batches);
  const auto simulators = cloneSerially(prototype, threads);
  FirstException failure;
  Progress progress(options);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (int batch = 0; batch < batches; ++batch) {
    if (failure.happened()) {
      continue;
    }
    try {
      const int first = batch * options.batch_size;
      const int count = std::min(options.batch_size, samples - first);
      simulateBatch(*simulators[omp_get_thread_num()], first, count, result);
      progress.add(count);
    } catch (...) {
      failure.keepCurrent();
    }
  }
  failure.rethrow();
  return result;
}

}  // namespace twinmap
