#pragma once

#include <array>
#include <optional>

#include "framework/spec/expression/expression.hpp"

namespace twinmap {

/// A condition that the result must meet: a metric of one parameter, or of each, within limits.
struct GateSpec {
  Name metric;                    ///< one of kGateMetrics
  std::optional<Name> parameter;  ///< none: every parameter
  std::optional<double> min, max;
};

/// The columns of metrics.csv that a gate may hold.
inline constexpr std::array<const char*, 18> kGateMetrics{
    "bias_pct",       "sd_pct",     "mare_pct",       "coverage95", "coverage90", "coverage50",
    "stddev_pct",     "z_mean",     "z_sd",           "nlpd",       "crps_pct",   "limit_pct",
    "ratio_to_limit", "loo_sd_pct", "loo_coverage95", "loo_nlpd",   "nlml",       "test_samples"};

}  // namespace twinmap
