#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/column_spec.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/model/bounds_spec.hpp"

namespace twinmap {

/// Where an output stands in a table of measurements, or in another one beside it. At most one of `time` and
/// `sample_rate` is given; neither: the times of the measurement.
struct MeasuredColumnSpec {
  Name name;                         ///< the output
  std::optional<ColumnSpec> column;  ///< default: its own name, in its own unit
  std::optional<Name> file{};        ///< of a recorder of its own; beside the measurement
  std::optional<ColumnSpec> time{};
  std::optional<double> sample_rate{};  ///< Hz; the first row is at time 0
  Expression delay{};                   ///< s, by which its clock is late: its time is start + t + delay
};

template <class Fields>
void describe(Fields& f, MeasuredColumnSpec& s) {
  f.scalarIsValueOf("column");
  f.optional("column", s.column, "such as 'enc1 [mm]' (default: the output's name, in its unit)");
  f.optional("file", s.file,
             "that has the column, in the folder of the measurement (default: the measurement)");
  f.optional("time", s.time, "column of its times, such as 't_fast [ms]' (default: that of the measurement)");
  f.optional("sample_rate", s.sample_rate, "instead of a column of times; Hz", kPositive);
  f.optional("delay", s.delay, "by which its clock is late: its time is start + t + delay", Unit{"s"});
  f.rule(!s.time || !s.sample_rate, "must give time or sample_rate, not both");
}

/// The time in the table at which the model's time is 0.
struct MeasurementStartSpec {
  double time = 0.0;         ///< s; from the trigger on where there is one
  std::optional<Name> when;  ///< "first", a date and time, or a trigger: "F > 0.5"
};

template <class Fields>
void describe(Fields& f, MeasurementStartSpec& s) {
  f.scalarIsValueOf("time");
  f.optional("time", s.time, "time in the table at which the model's time is 0, from `when` on; s");
  f.optional(
      "when", s.when,
      "where that is counted from: first (the first row), a date and time, or the first row at which a "
      "column passes a number, such as 'F > 0.5' (default: the table's time 0)");
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
  MeasurementStartSpec start;         ///< the time in the table at which the model's time is 0
  std::vector<MeasuredColumnSpec> columns;
  std::vector<Name> unwrap;                 ///< outputs whose columns jump by a whole turn
  std::vector<MeasuredRangeSpec> ranges{};  ///< of sensors that clip
  std::optional<Name> modes{};              ///< the file of a table of modes, beside the measurement
};

template <class Fields>
void describe(Fields& f, MeasurementSpec& s) {
  f.optional("time", s.time, "column of the times, such as 't [ms]' (default: t or time, in s)");
  f.optional("sample_rate", s.sample_rate, "instead of a column of times; Hz", kPositive);
  f.optional("start", s.start, "time in the table at which the model's time is 0; s");
  f.optionalMap("columns", s.columns,
                "where each output stands: a column, such as 'enc1 [mm]', or its own file and clock");
  f.optional("unwrap", s.unwrap, "outputs that are angles and jump by a whole turn in the table", kNotEmpty);
  f.optionalMap("range", s.ranges,
                "[lowest, highest] of each sensor that clips, in its output's unit: samples at these say no "
                "more than that the response is beyond");
  f.optional(
      "modes", s.modes,
      "file with a table of modes, in the folder of the measurement (default: the measurement, where no "
      "feature has times)");
  f.rule(!s.time || !s.sample_rate, "must give time or sample_rate, not both");
}

}  // namespace twinmap
