#include "framework/data/measurement/time_series.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/trim.hpp"
#include "framework/experiment/expression/units.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

const Column& getTimeColumn(const Table& table, const TimeBase& base) {
  const std::vector<std::string> names = listTimeColumns(base);
  for (const std::string& name : names) {
    if (const Column* column = findColumn(table, name)) {
      return *column;
    }
  }
  if (!base.time) {
    throw MeasurementError(
        table.source + ": has no column named t or time; give measurement.time or measurement.sample_rate");
  }
  return getColumn(table, base.time->name);
}

UnitConversion findConversion(const Table& table, const Column& column, const ColumnSpec& wanted,
                              const std::string& unit) {
  if (unit.empty()) {
    return {};
  }
  const bool by_table = !wanted.unit && column.unit;
  try {
    return calcUnitConversion(wanted.unit.value_or(column.unit.value_or(unit)), unit,
                              by_table ? SourceLocation{table.source, 0, 0, column.name} : wanted.where);
  } catch (const ExperimentError& error) {
    throw MeasurementError(error.what());
  }
}

/// A unit that ends a name, behind a bracket, a comma, a slash or, of times, an underscore; "" where none
/// does. One that changes no number is none. In brackets behind times stands a unit, even an unknown one.
/// "x_in" may be an input, "log (left)" a side.
std::string findHiddenUnit(const std::string& name, const std::string& unit) {
  const bool of_times = unit == "s";
  const std::size_t open = name.find_last_of(of_times ? "(,/_" : "(,/");
  const bool in_brackets = open != std::string::npos && name[open] == '(' && name.back() == ')';
  if (open == std::string::npos || open == 0 || (name[open] == '(' && !in_brackets)) {
    return "";
  }
  const std::string tail = trim(name.substr(open + 1, name.size() - open - (in_brackets ? 2 : 1)));
  if (!isUnit(tail)) {
    return of_times && in_brackets ? tail : "";
  }
  try {
    const UnitConversion conversion = calcUnitConversion(tail, unit, {});
    return conversion.factor != 1.0 || conversion.offset != 0.0 ? tail : "";
  } catch (const ExperimentError&) {
    return "";  // of another dimension
  }
}

void requireIncreasing(const Table& table, const Column& column, const VectorXd& times) {
  const double* end = times.data() + times.size();
  const double* bad = std::adjacent_find(times.data(), end, std::greater_equal<>());
  if (bad != end) {
    const Index row = bad - times.data() + 1;
    throw MeasurementError(table.source + ": column '" + column.name + "' has " + toText(column.values[row]) +
                           " in row " + std::to_string(row + 1) + ", after " +
                           toText(column.values[row - 1]) + "; times must increase");
  }
}

}  // namespace

std::vector<std::string> listTimeColumns(const TimeBase& base) {
  if (base.sample_rate) {
    return {};
  }
  return base.time ? std::vector<std::string>{base.time->name} : std::vector<std::string>{"t", "time"};
}

std::string describeAssumedUnit(const Table& table, const TimeBase& base) {
  if (base.sample_rate) {
    return "";
  }
  const Column& column = getTimeColumn(table, base);
  const bool is_stated = column.unit || (base.time && base.time->unit);
  return is_stated ? "" : fmt::format("column '{}' states no unit: s is assumed", column.name);
}

std::string describeUnreadUnit(const Table& table, const ColumnSpec& wanted, const std::string& unit) {
  const Column* column = findColumn(table, wanted.name);
  const std::string hidden = column == nullptr || column->unit || wanted.unit || unit.empty()
                                 ? ""
                                 : findHiddenUnit(column->name, unit);
  if (hidden.empty()) {
    return "";
  }
  return fmt::format(
      "{}: '{}' in the name of column '{}' is not read as its unit: {} is assumed; write the unit in square "
      "brackets behind the name, in the file or in the measurement section: '{} [{}]'",
      table.source, hidden, column->name, unit, column->name, isUnit(hidden) ? hidden : "ms");
}

VectorXd readUnorderedTimes(const Table& table, const TimeBase& base, Index rows) {
  if (base.sample_rate) {
    return VectorXd::NullaryExpr(
        rows, [&](Index i) { return static_cast<double>(i) / *base.sample_rate - base.start; });
  }
  const Column& column = getTimeColumn(table, base);
  const UnitConversion conversion =
      findConversion(table, column, base.time.value_or(ColumnSpec{column.name, {}, {}}), "s");
  return column.values.unaryExpr([&](double t) { return conversion.apply(t) - base.start; });
}

VectorXd readTimes(const Table& table, const TimeBase& base, Index rows) {
  VectorXd times = readUnorderedTimes(table, base, rows);
  if (!base.sample_rate) {
    requireIncreasing(table, getTimeColumn(table, base), times);
  }
  return times;
}

void requireClock(const Table& table, const TimeBase& base, const VectorXd& times) {
  constexpr Index kTenth = 10;  // rows out of order are single packets
  const Index steps = times.size() - 1;
  const auto countBack = [](const VectorXd& values) {
    const Index count = values.size() - 1;
    return (values.tail(count).array() <= values.head(count).array()).count();
  };
  if (base.sample_rate || steps < kTenth || countBack(times) * kTenth < steps) {
    return;
  }
  const std::string& clock = getTimeColumn(table, base).name;
  for (const Column& column : table.columns) {
    if (column.values.size() == times.size() && column.values.allFinite() && countBack(column.values) == 0) {
      throw MeasurementError(fmt::format(
          "{}: time '{}' goes back or stands in {} of {} rows, while '{}' rises in every one: are the two "
          "names swapped?",
          table.source, clock, countBack(times), times.size(), column.name));
    }
  }
}

VectorXd readValues(const Table& table, const ColumnSpec& wanted, const std::string& unit, Index first,
                    Index count) {
  const Column& column = getColumn(table, wanted.name);
  const UnitConversion conversion = findConversion(table, column, wanted, unit);
  return column.values.segment(first, count).unaryExpr([&](double x) { return conversion.apply(x); });
}

void requireLength(const Table& table, const Column& column, Index times) {
  if (column.values.size() != times) {
    throw MeasurementError(table.source + ": column '" + column.name + "' has " +
                           std::to_string(column.values.size()) + " numbers, but there are " +
                           std::to_string(times) + " times");
  }
}

RowRange findRows(const VectorXd& times, double from, double to, Index margin) {
  const double* begin = times.data();
  const double* end = begin + times.size();
  const Index last = std::lower_bound(begin, end, to) - begin + 1 + margin;
  const Index first = std::upper_bound(begin, end, from) - begin - 1 - margin;
  const Index kept = std::clamp<Index>(first, 0, times.size());
  return {kept, std::max<Index>(0, std::min<Index>(last, times.size()) - kept)};
}

VectorXd unwrap(const VectorXd& times, const VectorXd& values, double turn) {
  VectorXd unwrapped = values;
  Index before = -1, last = -1;
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      continue;
    }
    if (last >= 0) {
      const double slope =
          before < 0 ? 0.0 : (unwrapped[last] - unwrapped[before]) / (times[last] - times[before]);
      const double expected = unwrapped[last] + slope * (times[i] - times[last]);
      unwrapped[i] += turn * std::round((expected - values[i]) / turn);
    }
    before = last;
    last = i;
  }
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && (times[i] >= 0.0 || i == last)) {
      return unwrapped.array() - turn * std::round((unwrapped[i] - values[i]) / turn);
    }
  }
  return unwrapped;
}

std::vector<Index> findTurnJumps(const VectorXd& values, double turn) {
  constexpr double kSmall = 0.15;  // of a turn
  constexpr double kUsual = 0.9;   // of the changes
  std::vector<Index> there, jumps;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      there.push_back(i);
    }
  }
  const VectorXd known = values(there);
  const Index steps = known.size() - 1;
  if (steps < 2) {
    return jumps;
  }
  const VectorXd changes = known.tail(steps) - known.head(steps);
  const auto is_jump = [&](Index i) { return std::abs(std::abs(changes[i]) - turn) < kSmall * turn; };
  const auto small = (changes.array().abs() < kSmall * turn).count();
  for (Index i = 0; i < steps && static_cast<double>(small) >= kUsual * static_cast<double>(steps); ++i) {
    const bool goes_back = i + 1 < steps && is_jump(i + 1) && changes[i] * changes[i + 1] < 0.0;
    const bool came_back = i > 0 && is_jump(i - 1) && changes[i] * changes[i - 1] < 0.0;
    if (is_jump(i) && !goes_back && !came_back) {
      jumps.push_back(there[static_cast<std::size_t>(i + 1)]);
    }
  }
  return jumps;
}

std::string describeTime(double seconds) {
  constexpr int kDigits = 6, kDigitsOfStamps = 13;
  constexpr double kStamp = 1e5;
  return toShortText(seconds, std::abs(seconds) < kStamp ? kDigits : kDigitsOfStamps) + " s";
}

double calcMedianStep(const VectorXd& times) {
  return calcMedian(VectorXd(times.tail(times.size() - 1) - times.head(times.size() - 1)));
}

}  // namespace twinmap
