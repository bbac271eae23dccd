#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/column_spec.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/model/bounds_spec.hpp"

namespace twinmap {

/// Where an output stands in a table of measurements.
struct MeasuredColumnSpec {
  Name name;  ///< the output
  ColumnSpec column;
};

template <class Fields>
void describe(Fields& f, MeasuredColumnSpec& s) {
  f.value(s.column);
}

/// What a sensor can show: beyond it a response is clipped.
struct MeasuredRangeSpec {
  Name name;  ///< an output
  Bounds range;
};

template <class Fields>
void describe(Fields& f, MeasuredRangeSpec& s) {
  f.value(s.range);
}

/// How measurements are read: at most one of `time` and `sample_rate` is given; neither: a column named t or
/// time, in s unless the table states a unit. Outputs that are not listed stand in columns of their own name.
/// A unit here goes before the one that the table states; without either a column is in its output's unit.
struct MeasurementSpec {
  std::optional<ColumnSpec> time;
  std::optional<double> sample_rate;  ///< Hz; the first row is at time 0
  double start = 0.0;                 ///< time in the table (s) at which the model's time is 0
  std::vector<MeasuredColumnSpec> columns;
  std::vector<Name> unwrap;                 ///< outputs whose columns jump by a whole turn
  std::vector<MeasuredRangeSpec> ranges{};  ///< of sensors that clip
};

template <class Fields>
void describe(Fields& f, MeasurementSpec& s) {
  f.optional("time", s.time, "column of the times, such as 't [ms]' (default: t or time, in s)");
  f.optional("sample_rate", s.sample_rate, "instead of a column of times; Hz", kPositive);
  f.optional("start", s.start, "time in the table at which the model's time is 0; s");
  f.optionalMap("columns", s.columns,
                "column of each output, such as 'enc1 [mm]' (default: its own name, in its own unit)");
  f.optional("unwrap", s.unwrap, "outputs that are angles and jump by a whole turn in the table", kNotEmpty);
  f.optionalMap("range", s.ranges,
                "[lowest, highest] of each sensor that clips, in its output's unit: samples at these say no "
                "more than that the response is beyond");
  f.rule(!s.time || !s.sample_rate, "must give time or sample_rate, not both");
}

}  // namespace twinmap
