#pragma once

#include <string>
#include <vector>

#include "framework/inference/inferrer.hpp"
#include "framework/report/history/history_page.hpp"

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

/// What the page says of one measurement. parameters: those that are reported.
ShownInference showInference(const InferredMeasurement& inferred,
                             const std::vector<ParameterSpec>& parameters,
                             const std::vector<FeatureInfo>& features);

}  // namespace twinmap::cli
