#pragma once

#include "framework/inference/inferrer.hpp"
#include "framework/report/history/history.hpp"

namespace twinmap::cli {

/// The estimates of a call, in order: what the parameters did over its measurements.
class InferHistory {
 public:
  explicit InferHistory(std::vector<ParameterSpec> parameters) {
    history_.parameters = std::move(parameters);
  }

  /// Measurements without an estimate are no part of it.
  void add(const InferredMeasurement& inferred);

  const History& get() const { return history_; }

 private:
  History history_;
};

}  // namespace twinmap::cli
