#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "framework/base/worker/program_process.hpp"
#include "framework/experiment/model/source_spec.hpp"

namespace twinmap {

/// A running program that has answered the first line.
class ProgramWorker {
 public:
  /// Throws WorkerFailure where it cannot be started, ProtocolError where its answer is another.
  ProgramWorker(const ProgramSpec& spec, const std::string& hello);

  /// As ProgramProcess::exchange; `samples` are in the request.
  std::string exchange(const std::string& request, int samples, double timeout);

  /// Whether no sample came before, so that nothing before can be the cause of a failure.
  bool isFresh() const { return samples_ == 0; }
  /// Whether it has taken much memory since its first samples; looked at now and then only.
  bool hasGrown();

 private:
  ProgramProcess process_;
  long samples_ = 0, checked_ = 0;
  double first_size_ = 0.0;
};

/// Workers that wait for samples, shared by all clones of a simulator.
class ProgramPool {
 public:
  ProgramPool(const ProgramSpec& spec, std::string hello) : spec_(spec), hello_(std::move(hello)) {}

  /// One that waits, or another one; with `fresh` always another. Waits where all that may run are taken.
  /// Throws as ProgramWorker does; ExperimentError where none has ever been started.
  std::unique_ptr<ProgramWorker> take(bool fresh = false);

  /// A worker to use again, or null for one that is no more.
  void giveBack(std::unique_ptr<ProgramWorker> worker);

  const ProgramSpec& getSpec() const { return spec_; }

 private:
  std::unique_ptr<ProgramWorker> start();

  const ProgramSpec spec_;
  const std::string hello_;
  std::mutex access_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<ProgramWorker>> idle_;
  int taken_ = 0;
  bool has_started_ = false;
};

}  // namespace twinmap
