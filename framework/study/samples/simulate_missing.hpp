#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "framework/base/log/run_control.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

struct SimulationProgress {
  int total = 0;      ///< samples that were not in the store
  int simulated = 0;  ///< of them, until now
  int failed = 0;     ///< of those
  int implicit = 0;   ///< simulated by an implicit method after the step limit (SampleStatus::stiff_retry)
  int reused = 0;     ///< samples that were in the store
  int given_up = 0;   ///< of the total: not simulated, since all before had failed (MissingOptions)
};

struct MissingOptions {
  int threads = 0;             ///< 0: as many as OpenMP offers
  int chunk_samples = 256;     ///< a chunk is written when so many samples wait (fewer if they are large),
  double chunk_seconds = 2.0;  ///< or when a sample is finished so long after the last chunk
  /// Fraction of the samples that may fail (simulation.allowed_failures). Where so many fail in a row from
  /// the first on, stored ones included, that it is as unlikely as a dozen of which half may fail, no other
  /// is begun. 1: all are simulated.
  double allowed_failures = 1.0;
  /// Once true, the samples under way are finished and written, and no other is begun.
  const std::atomic<bool>* stop = nullptr;
  /// Called after each sample, from any thread but one at a time.
  std::function<void(const SimulationProgress&)> progress;
};

/// Options for a stage of a run that simulates, called `stage` where progress is shown; `simulations` are
/// behind each sample.
MissingOptions makeMissingOptions(const std::string& stage, int simulations, const RunControl& control);

struct StoredTrajectories {
  /// Samples that were not reached: NaN, "not simulated", with the reason where they were given up.
  Trajectories trajectories;
  SimulationProgress counts;
  bool stopped = false;  ///< by the flag, with samples left
};

/// The responses at the columns of `points`: those in the store are taken from it, the others, each distinct
/// one once, are simulated as by generateSamples() and stored. Every response comes back from the store, so
/// that the result is bitwise the same for any number of threads, chunk size and history. Whether samples are
/// given up depends on the points and on what is stored of them, never on the number of threads: the first
/// dozen is waited for before others begin, unless a stored sample has shown that the model can be simulated.
///
/// What is lost when the process is killed are the samples under way and those finished within chunk_seconds.
/// An exception, of a simulator or because a chunk cannot be written (disk full: std::runtime_error naming
/// the file), is thrown again after what else was finished has been written, as far as that is possible. Cost
/// beside the simulations: some 10 ms to sync each chunk, on one of the threads. Memory: the responses, and
/// up to 128 MiB of chunks.
StoredTrajectories simulateMissing(TrajectoryStore& store, const Simulator& simulator,
                                   const Eigen::MatrixXd& points, const MissingOptions& options = {});

/// The same without reading the responses. Stopped, if fewer are simulated or given up than the total.
SimulationProgress storeMissing(TrajectoryStore& store, const Simulator& simulator,
                                const Eigen::MatrixXd& points, const MissingOptions& options = {});

/// Whether what is stored of the points are failures alone, so many that simulateMissing() would begin no
/// other.
bool isGivenUp(const TrajectoryStore& store, const Eigen::MatrixXd& points, double allowed_failures);

}  // namespace twinmap
