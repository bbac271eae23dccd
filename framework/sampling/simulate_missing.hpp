#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "framework/monitoring/run_control.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

struct SimulationProgress {
  int total = 0;      ///< samples that were not in the store
  int simulated = 0;  ///< of them, until now
  int failed = 0;     ///< of those
  int reused = 0;     ///< samples that were in the store
};

struct MissingOptions {
  int threads = 0;             ///< 0: as many as OpenMP offers
  int chunk_samples = 256;     ///< a chunk is written when so many samples wait (fewer if they are large),
  double chunk_seconds = 2.0;  ///< or when a sample is finished so long after the last chunk
  /// Once true, the samples under way are finished and written, and no other is begun.
  const std::atomic<bool>* stop = nullptr;
  /// Called after each sample, from any thread but one at a time.
  std::function<void(const SimulationProgress&)> progress;
};

/// Options for a stage of a run that simulates, called `stage` where progress is shown; `simulations` are
/// behind each sample.
MissingOptions makeMissingOptions(const std::string& stage, int simulations, const RunControl& control);

struct StoredTrajectories {
  Trajectories trajectories;  ///< samples that were not reached: NaN, "not simulated"
  SimulationProgress counts;
  bool stopped = false;  ///< by the flag, with samples left
};

/// The responses at the columns of `points`: those in the store are taken from it, the others, each distinct
/// one once, are simulated as by generateSamples() and stored. Every response comes back from the store, so
/// that the result is bitwise the same for any number of threads, chunk size and history.
///
/// What is lost when the process is killed are the samples under way and those finished within chunk_seconds.
/// An exception, of a simulator or because a chunk cannot be written (disk full: std::runtime_error naming
/// the file), is thrown again after what else was finished has been written, as far as that is possible. Cost
/// beside the simulations: some 10 ms to sync each chunk, on one of the threads. Memory: the responses, and
/// up to 128 MiB of chunks.
StoredTrajectories simulateMissing(TrajectoryStore& store, const Simulator& simulator,
                                   const Eigen::MatrixXd& points, const MissingOptions& options = {});

/// The same without reading the responses. Stopped, if fewer are simulated than the total.
SimulationProgress storeMissing(TrajectoryStore& store, const Simulator& simulator,
                                const Eigen::MatrixXd& points, const MissingOptions& options = {});

}  // namespace twinmap
