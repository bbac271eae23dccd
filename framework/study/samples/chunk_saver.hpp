#pragma once

#include <chrono>
#include <mutex>
#include <vector>

#include "framework/simulation/sample_generator.hpp"
#include "framework/store/trajectory_store.hpp"
#include "framework/study/samples/missing_options.hpp"

namespace twinmap {

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

}  // namespace twinmap
