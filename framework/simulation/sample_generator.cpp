#include "framework/simulation/sample_generator.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "framework/simulation/simulator_team.hpp"

namespace twinmap {
namespace {

Trajectories prepare(const Simulator& prototype, const Eigen::MatrixXd& parameters) {
  Trajectories result;
  result.parameters = parameters;
  result.layout = prototype.getLayout();
  result.responses.setConstant(result.layout.getRowCount(), parameters.cols(),
                               std::numeric_limits<double>::quiet_NaN());
  result.statuses.assign(parameters.cols(), {false, "not simulated"});
  return result;
}

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

void check(const GeneratorOptions& options) {
  if (options.batch_size.value_or(1) < 1 || options.threads < 0) {
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
  const int size = options.batch_size.value_or(prototype.getBatchSize());
  const int batches = (samples + size - 1) / size;
  Progress progress(options);
  runOnTeam(prototype, batches, options.threads, [&](Simulator& simulator, int batch) {
    if (options.stop != nullptr && options.stop->load(std::memory_order_relaxed)) {
      return;
    }
    const int first = batch * size;
    const int count = std::min(size, samples - first);
    simulateBatch(simulator, first, count, result);
    if (options.finished) {
      options.finished(result, first, count);
    }
    progress.add(count);
  });
  return result;
}

}  // namespace twinmap
