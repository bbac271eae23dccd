#include "framework/study/samples/simulate_missing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

#include "framework/study/samples/model_store.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Collects finished samples from any thread and writes them in chunks; meanwhile the other threads go on.
class ChunkSaver {
 public:
  ChunkSaver(TrajectoryStore& store, const MissingOptions& options, const SimulationProgress& counts);

  /// Samples first .. first + count - 1 of `all` are finished. Writes a chunk if it is time.
  void add(const Trajectories& all, int first, int count);
  /// Writes what waits.
  void flush();

  const SimulationProgress& getCounts() const { return counts_; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Sample {
    Eigen::VectorXd parameters, response;
    SampleStatus status;
  };

  void addOne(const Trajectories& all, int sample);
  bool isDue() const;
  /// All that waits if a chunk is due, else nothing.
  std::vector<Sample> takeDue();
  void write(const std::vector<Sample>& samples);

  TrajectoryStore& store_;
  const MissingOptions& options_;
  std::size_t chunk_samples_;
  std::mutex mutex_;
  SimulationProgress counts_;
  std::vector<Sample> waiting_;
  Clock::time_point last_chunk_ = Clock::now();
};

/// As many samples as asked for, but not above 32 MiB, for samples may be of any size.
std::size_t chooseChunkSamples(const TrajectoryStore& store, const MissingOptions& options) {
  constexpr std::uint64_t kMaxBytes = 32u << 20;
  const std::uint64_t fitting = kMaxBytes / calcChunkSize(store.getShape(), 1);
  const auto wanted = static_cast<std::uint64_t>(std::max(options.chunk_samples, 1));
  return std::clamp<std::uint64_t>(fitting, 1, wanted);
}

ChunkSaver::ChunkSaver(TrajectoryStore& store, const MissingOptions& options,
                       const SimulationProgress& counts)
    : store_(store), options_(options), chunk_samples_(chooseChunkSamples(store, options)), counts_(counts) {}

void ChunkSaver::addOne(const Trajectories& all, int sample) {
  waiting_.push_back({all.parameters.col(sample), all.responses.col(sample), all.statuses[sample]});
  ++counts_.simulated;
  counts_.failed += all.statuses[sample].ok ? 0 : 1;
  counts_.implicit += all.statuses[sample].ok && all.statuses[sample].stiff_retry ? 1 : 0;
  if (options_.progress) {
    options_.progress(counts_);
  }
}

bool ChunkSaver::isDue() const {
  const std::chrono::duration<double> waited = Clock::now() - last_chunk_;
  return waiting_.size() >= chunk_samples_ || waited.count() >= options_.chunk_seconds;
}

std::vector<ChunkSaver::Sample> ChunkSaver::takeDue() {
  std::vector<Sample> taken;
  if (isDue()) {
    taken.swap(waiting_);
    last_chunk_ = Clock::now();
  }
  return taken;
}

void ChunkSaver::add(const Trajectories& all, int first, int count) {
  std::vector<Sample> due;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    for (int sample = first; sample < first + count; ++sample) {
      addOne(all, sample);
    }
    due = takeDue();
  }
  write(due);
}

void ChunkSaver::flush() {
  write(waiting_);
  waiting_.clear();
}

void ChunkSaver::write(const std::vector<Sample>& samples) {
  if (samples.empty()) {
    return;
  }
  const auto count = static_cast<Eigen::Index>(samples.size());
  SampleBlock block;
  block.parameters.resize(samples.front().parameters.size(), count);
  block.responses.resize(samples.front().response.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    block.parameters.col(i) = samples[i].parameters;
    block.responses.col(i) = samples[i].response;
    block.statuses.push_back(samples[i].status);
  }
  store_.append(block);
}

void flushQuietly(ChunkSaver& saver) {
  try {
    saver.flush();
  } catch (const std::exception&) {
    // The exception that ended the simulations is the one to report.
  }
}

void simulateAll(const Simulator& simulator, const MatrixXd& points, const MissingOptions& options,
                 ChunkSaver& saver) {
  GeneratorOptions generator;
  generator.threads = options.threads;
  generator.stop = options.stop;
  generator.finished = [&](const Trajectories& all, int first, int count) { saver.add(all, first, count); };
  try {
    generateSamples(simulator, points, generator);
  } catch (...) {
    flushQuietly(saver);
    throw;
  }
}

/// How many failures in a row say that all will fail: a dozen, or as many as are as unlikely where more than
/// half of the samples may fail. None do where all may.
int calcProbeSize(double allowed_failures) {
  constexpr double kDozen = 12.0, kHalf = 0.5;
  if (allowed_failures >= 1.0) {
    return std::numeric_limits<int>::max();
  }
  const double allowed = std::max(allowed_failures, kHalf);
  return static_cast<int>(std::ceil(std::min(kDozen * std::log(kHalf) / std::log(allowed), 1e9)));
}

/// What the store knows of some points.
struct StoredOutcome {
  int succeeded = 0, failed = 0;
};

StoredOutcome countStored(const TrajectoryStore& store, const MatrixXd& points) {
  StoredOutcome outcome;
  for (const auto& point : points.colwise()) {
    if (store.contains(point)) {
      ++(store.hasFailed(point) ? outcome.failed : outcome.succeeded);
    }
  }
  return outcome;
}

/// Simulates only so many points as show, with what is stored, whether all fail. True if they do.
bool probe(const Simulator& simulator, const MatrixXd& missing, const StoredOutcome& stored,
           const MissingOptions& options, ChunkSaver& saver) {
  const int needed = calcProbeSize(options.allowed_failures) - stored.failed;
  simulateAll(simulator, missing.leftCols(std::clamp<Index>(needed, 0, missing.cols())), options, saver);
  const SimulationProgress& done = saver.getCounts();
  return done.failed == done.simulated && done.failed >= needed;
}

/// Simulates the missing points, or gives up. Returns how many it gave up.
int simulateOrGiveUp(const Simulator& simulator, const MatrixXd& missing, const StoredOutcome& stored,
                     const MissingOptions& options, ChunkSaver& saver) {
  const bool doubtful = stored.succeeded == 0 && options.allowed_failures < 1.0;
  const bool all_fail = doubtful && probe(simulator, missing, stored, options, saver);
  const Index left = missing.cols() - saver.getCounts().simulated;
  if (!all_fail) {
    simulateAll(simulator, missing.rightCols(left), options, saver);
  }
  return all_fail ? static_cast<int>(left) : 0;
}

/// Gives samples that were given up their reason.
void explainGivenUp(const MatrixXd& points, const TrajectoryStore& store,
                    std::vector<SampleStatus>& statuses) {
  std::string reason;
  for (Index i = 0; i < points.cols() && reason.empty(); ++i) {
    reason = store.contains(points.col(i)) ? statuses[i].reason : "";
  }
  for (Index i = 0; i < points.cols(); ++i) {
    if (!store.contains(points.col(i))) {
      statuses[i].reason = fmt::format("not simulated, since every sample before failed: {}", reason);
    }
  }
}

Trajectories loadTrajectories(const TrajectoryStore& store, const ResponseLayout& layout,
                              const MatrixXd& points) {
  SampleBlock block = store.load(points);
  Trajectories trajectories;
  trajectories.layout = layout;
  trajectories.parameters = std::move(block.parameters);
  trajectories.responses = std::move(block.responses);
  trajectories.statuses = std::move(block.statuses);
  return trajectories;
}

}  // namespace

MissingOptions makeMissingOptions(const std::string& stage, int simulations, const RunControl& control) {
  MissingOptions missing;
  missing.threads = control.threads;
  missing.stop = control.stop;
  if (control.progress) {
    missing.progress = [stage, simulations, progress = control.progress](const SimulationProgress& counts) {
      progress({stage, simulations * counts.simulated, simulations * counts.total,
                simulations * counts.failed, double(counts.simulated) / counts.total, true});
    };
  }
  return missing;
}

SimulationProgress storeMissing(TrajectoryStore& store, const Simulator& simulator, const MatrixXd& points,
                                const MissingOptions& options) {
  const std::size_t set_aside = store.getSetAside().size();
  store.refresh();
  store.verify(points);
  logSetAside(store, set_aside);
  const std::vector<Index> missing = store.findMissing(points);
  SimulationProgress counts;
  counts.total = static_cast<int>(missing.size());
  counts.reused = static_cast<int>(points.cols()) - counts.total;
  ChunkSaver saver(store, options, counts);
  const int given_up =
      simulateOrGiveUp(simulator, points(Eigen::all, missing), countStored(store, points), options, saver);
  saver.flush();
  counts = saver.getCounts();
  counts.given_up = given_up;
  return counts;
}

bool isGivenUp(const TrajectoryStore& store, const MatrixXd& points, double allowed_failures) {
  const StoredOutcome stored = countStored(store, points);
  return stored.succeeded == 0 && stored.failed >= calcProbeSize(allowed_failures);
}

StoredTrajectories simulateMissing(TrajectoryStore& store, const Simulator& simulator, const MatrixXd& points,
                                   const MissingOptions& options) {
  const SimulationProgress counts = storeMissing(store, simulator, points, options);
  StoredTrajectories result{loadTrajectories(store, simulator.getLayout(), points), counts,
                            counts.simulated + counts.given_up < counts.total};
  if (counts.given_up > 0) {
    explainGivenUp(points, store, result.trajectories.statuses);
  }
  return result;
}

}  // namespace twinmap
