#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "framework/inference/inferrer.hpp"
#include "framework/inference/measurement_session.hpp"

namespace twinmap::python {

/// A trained map as Python holds it, for any number of threads: each borrows a session.
class PythonMap {
 public:
  explicit PythonMap(const std::filesystem::path& run_or_maps) : inferrer_(run_or_maps) {}

  const Inferrer& getInferrer() const { return inferrer_; }

  using Refine = std::optional<bool>;
  using Session = std::unique_ptr<MeasurementSession>;

  /// How a session infers (MeasurementSession).
  using Manner = std::pair<Refine, int>;  ///< the draws of posteriors

  /// A session that infers so, perhaps one that was given back. From any thread.
  Session borrow(const Manner& manner);
  void giveBack(const Manner& manner, Session session);

 private:
  const Inferrer inferrer_;
  std::mutex mutex_;
  std::map<Manner, std::vector<Session>> idle_;
};

}  // namespace twinmap::python
