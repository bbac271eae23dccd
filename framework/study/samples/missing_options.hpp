#pragma once

#include <atomic>
#include <functional>

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

}  // namespace twinmap
