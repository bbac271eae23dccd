#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/simulation/simulator.hpp"

namespace twinmap {

struct Trajectories;

struct GeneratorOptions {
  int threads = 0;                  ///< 0: as many as OpenMP offers
  std::optional<int> batch_size{};  ///< samples handed to the simulator at once; by default as it says
  /// Called with the number of samples done so far, from any thread but one at a time.
  std::function<void(int done)> progress;
  /// Once true, samples under way are finished and no other is begun; those keep "not simulated" as reason.
  const std::atomic<bool>* stop = nullptr;
  /// Called when samples first .. first + count - 1 are there, from any thread, several at a time.
  std::function<void(const Trajectories& all, int first, int count)> finished = nullptr;
};

/// Clean responses of a set of parameter points, one column a sample.
struct Trajectories {
  Eigen::MatrixXd parameters;          ///< parameters x n
  Eigen::MatrixXd responses;           ///< rows of the layout x n; NaN where a sample failed
  std::vector<SampleStatus> statuses;  ///< n
  ResponseLayout layout;

  int getSampleCount() const { return static_cast<int>(parameters.cols()); }
  int calcFailureCount() const;
};

/// Simulates every column of `parameters` on a pool of threads. The result is bitwise the same for any number
/// of threads and any batch size. A sample that fails keeps its place. `prototype` is cloned, not used. An
/// exception of a simulator (a bug or a wrong experiment, never a numerical failure) stops the generation and
/// is thrown again. Throws std::invalid_argument for a batch size below 1 or a negative number of threads.
Trajectories generateSamples(const Simulator& prototype, const Eigen::MatrixXd& parameters,
                             const GeneratorOptions& options = {});

}  // namespace twinmap
