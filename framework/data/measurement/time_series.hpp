#pragma once

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/column_spec.hpp"

namespace twinmap {

/// How the times of a table's rows are known: by a column, at a constant rate, or (neither) by the column
/// named t or time.
struct TimeBase {
  std::optional<ColumnSpec> time;
  std::optional<double> sample_rate;  ///< Hz; the first row is at time 0
  double start = 0.0;                 ///< s, taken off all times
};

/// "1.545 s", a time since 1970 down to milliseconds: "1700000000.379 s".
std::string describeTime(double seconds);

/// The names of the columns that may hold the times, for readTable().
std::vector<std::string> listTimeColumns(const TimeBase& base);

/// What is assumed of a clock whose unit nobody states, as "column 't' states no unit: s is assumed". ""
/// where it is stated, or there is no column.
std::string describeAssumedUnit(const Table& table, const TimeBase& base);

/// A sentence on a unit in the name of a column, which is not read, as in "Zeit(ms)". It says that `unit` is
/// assumed and how to state another. "" where the name has none of that dimension.
std::string describeUnreadUnit(const Table& table, const ColumnSpec& wanted, const std::string& unit);

/// The times of the rows after the start (s), strictly increasing. `rows`: how many there are, for a constant
/// rate. Throws MeasurementError for a missing column, a unit that does not convert to s, and times that do
/// not increase. O(rows).
Eigen::VectorXd readTimes(const Table& table, const TimeBase& base, Eigen::Index rows);
/// The same, whatever their order, NaN where a row has no time.
Eigen::VectorXd readUnorderedTimes(const Table& table, const TimeBase& base, Eigen::Index rows);

/// Throws MeasurementError where the times go back in every tenth row or more, while another column rises in
/// every one, as where two names are swapped.
void requireClock(const Table& table, const TimeBase& base, const Eigen::VectorXd& times);

/// Rows `first` .. `first` + `count` - 1 of a column, converted to `unit`; "" takes the numbers as they
/// stand. The column's unit is the wanted one if that is given, else the one that the table states, else
/// `unit`. Throws MeasurementError for a missing column and a unit that does not convert.
Eigen::VectorXd readValues(const Table& table, const ColumnSpec& wanted, const std::string& unit,
                           Eigen::Index first, Eigen::Index count);

/// Values that a sensor shows within one turn, as they go on: each of those that are finite is moved by whole
/// turns to the nearest of where the two before it lead (in a straight line), or of the one before. The value
/// at the first time from 0 on stays. `times`: increasing. Right where the speed changes by less than half a
/// turn per sample within a sample.
Eigen::VectorXd unwrap(const Eigen::VectorXd& times, const Eigen::VectorXd& values, double turn);

/// Rows (the second of two neighbours) between which values change by a whole turn, within 0.15 of it, while
/// nine of ten changes are below 0.15 of it, and where the next value does not jump back, as it does at a
/// spike.
std::vector<Eigen::Index> findTurnJumps(const Eigen::VectorXd& values, double turn);

/// Throws MeasurementError unless the column has as many numbers as there are times.
void requireLength(const Table& table, const Column& column, Eigen::Index times);

/// Rows of increasing times from the last one at or before `from` to the first one at or after `to`, and
/// `margin` more on either side, where there are such.
struct RowRange {
  Eigen::Index first = 0, count = 0;
};
RowRange findRows(const Eigen::VectorXd& times, double from, double to, Eigen::Index margin);

/// Of a step: times that differ by less are the same, as files round them.
constexpr double kSameTime = 1e-6;

/// The median of the differences of two or more times.
double calcMedianStep(const Eigen::VectorXd& times);

}  // namespace twinmap
