#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "framework/inference/measurement/inference_source.hpp"

namespace twinmap::python {

/// A trained map, or an experiment alone, as Python holds it, for any number of threads: each borrows a
/// session.
class PythonMap {
 public:
  explicit PythonMap(const std::filesystem::path& run_or_maps) : source_(run_or_maps) {}
  explicit PythonMap(ExperimentSpec experiment) : source_(std::move(experiment)) {}

  const MeasurementReader& getReader() const { return source_.getReader(); }
  /// Throws std::logic_error of an experiment alone, which Python asks for none of its results.
  const Inferrer& getTrained() const;

  using Session = std::unique_ptr<MeasurementInference>;

  /// A session that infers so, perhaps one that was given back. From any thread.
  Session borrow(const SessionOptions& options);
  void giveBack(const SessionOptions& options, Session session);

 private:
  const InferenceSource source_;
  std::mutex mutex_;
  std::map<SessionOptions, std::vector<Session>> idle_;
};

}  // namespace twinmap::python
