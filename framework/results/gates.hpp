#pragma once

#include <string>
#include <vector>

#include "framework/base/text/csv.hpp"
#include "framework/experiment/gate_spec.hpp"

namespace twinmap {

/// Whether a run meets one of the experiment's gates.
struct GateResult {
  std::string condition;  ///< "0.93 <= coverage95 <= 0.97, every parameter"
  std::string found;      ///< "d_y 0.946, k_y 0.972", or why there is no value
  bool passed = false;
};

/// `metrics` has the columns of metrics.csv, one row per parameter (of a sweep: and case). A gate passes if
/// each of its values lies within [min, max]; one without a value fails.
GateResult checkGate(const GateSpec& gate, const CsvTable& metrics);
std::vector<GateResult> checkGates(const std::vector<GateSpec>& gates, const CsvTable& metrics);

}  // namespace twinmap
