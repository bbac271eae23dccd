#pragma once

#include "framework/data/measurement/table.hpp"
#include "framework/experiment/column_spec.hpp"

namespace twinmap {

/// How the times of a table's rows are known: by a column, at a constant rate, or (neither) by the column
/// named t or time.
struct TimeBase {
  std::optional<ColumnSpec> time;
  std::optional<double> sample_rate;  ///< Hz; the first row is at time 0
  double start = 0.0;                 ///< s, taken off all times
};

/// The names of the columns that may hold the times, for readTable().
std::vector<std::string> listTimeColumns(const TimeBase& base);

/// The times of the rows after the start (s), strictly increasing. `rows`: how many there are, for a constant
/// rate. Throws MeasurementError for a missing column, a unit that does not convert to s, and times that do
/// not increase. O(rows).
Eigen::VectorXd readTimes(const Table& table, const TimeBase& base, Eigen::Index rows);
/// The same, whatever their order, NaN where a row has no time.
Eigen::VectorXd readUnorderedTimes(const Table& table, const TimeBase& base, Eigen::Index rows);

/// Rows `first` .. `first` + `count` - 1 of a column, converted to `unit`; "" takes the numbers as they
/// stand. The column's unit is the wanted one if that is given, else the one that the table states, else
/// `unit`. Throws MeasurementError for a missing column and a unit that does not convert.
Eigen::VectorXd readValues(const Table& table, const ColumnSpec& wanted, const std::string& unit,
                           Eigen::Index first, Eigen::Index count);

/// Throws MeasurementError unless the column has as many numbers as there are times.
void requireLength(const Table& table, const Column& column, Eigen::Index times);

/// Rows of increasing times from the last one at or before `from` to the first one at or after `to`, and
/// `margin` more on either side, where there are such.
struct RowRange {
  Eigen::Index first = 0, count = 0;
};
RowRange findRows(const Eigen::VectorXd& times, double from, double to, Eigen::Index margin);

/// The median of the differences of two or more times.
double calcMedianStep(const Eigen::VectorXd& times);

}  // namespace twinmap
