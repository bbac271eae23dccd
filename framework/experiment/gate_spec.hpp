#pragma once

#include <array>
#include <optional>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A condition that the result must meet: a metric of one parameter, or of each, within limits.
struct GateSpec {
  Name metric;                    ///< one of kGateMetrics
  std::optional<Name> parameter;  ///< none: every parameter
  std::optional<double> min, max;
};

template <class Fields>
void describe(Fields& f, GateSpec& s) {
  f.required("metric", s.metric, "a column of metrics.csv, such as coverage95 or ratio_to_limit");
  f.optional("parameter", s.parameter, "the parameter it holds for (default: every one)");
  f.optional("min", s.min, "least value that passes");
  f.optional("max", s.max, "greatest value that passes");
  f.rule(s.min || s.max, "must give min, max or both");
  f.rule(!s.min || !s.max || *s.min <= *s.max, "must have min not above max");
}

/// The columns of metrics.csv that a gate may hold.
inline constexpr std::array<const char*, 19> kGateMetrics{
    "bias_pct",       "sd_pct",           "mare_pct",   "coverage95",     "coverage90", "coverage50",
    "stddev_pct",     "z_mean",           "z_sd",       "nlpd",           "crps_pct",   "limit_pct",
    "ratio_to_limit", "nats_above_limit", "loo_sd_pct", "loo_coverage95", "loo_nlpd",   "nlml",
    "test_samples"};

}  // namespace twinmap
