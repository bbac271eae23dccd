#pragma once

#include <optional>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A condition that the result must meet: a metric of one parameter, or of each, within limits.
struct GateSpec {
  Name metric;                    ///< one of listGateMetrics()
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

}  // namespace twinmap
