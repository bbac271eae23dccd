#include "framework/data/measurement/measurement_start.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/trim.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"
#include "framework/data/measurement/measurement.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr const char* kFirst = "first";

bool isPast(const Trigger& trigger, double value) {
  return trigger.above ? value > trigger.level : value < trigger.level;
}

/// The row with the least time among those that `passes` takes; -1 where there is none.
template <class Passes>
Index findEarliest(const VectorXd& times, const Passes& passes) {
  Index earliest = -1;
  for (Index i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i]) && passes(i) && (earliest < 0 || times[i] < times[earliest])) {
      earliest = i;
    }
  }
  return earliest;
}

double findTriggered(const Table& table, const Trigger& trigger, const VectorXd& times, Index first) {
  const Column& column = getColumn(table, trigger.column);
  requireLength(table, column, times.size());
  const auto describe = [&](const std::string& problem) {
    return fmt::format(
        "{}: column '{}' {} {} {}, so that measurement.start.when finds no start; change it, or "
        "give the time (--start)",
        table.source, trigger.column, problem, trigger.above ? "above" : "below", toText(trigger.level));
  };
  const Index found = findEarliest(times, [&](Index i) { return isPast(trigger, column.values[i]); });
  const Index seen = findEarliest(times, [&](Index i) { return std::isfinite(column.values[i]); });
  if (found < 0) {
    throw MeasurementError(describe("is never"));
  }
  if (found == seen && found == first) {
    throw MeasurementError(describe("is from its first row on"));
  }
  return times[found];
}

}  // namespace

std::optional<Trigger> findTrigger(const MeasurementStartSpec& start) {
  double stamp = 0.0;
  if (!start.when || start.when->text == kFirst || parseTimeStamp(start.when->text, stamp)) {
    return std::nullopt;
  }
  const std::string& text = start.when->text;
  const std::size_t sign = text.find_last_of("<>");
  Trigger trigger;
  if (sign != std::string::npos) {
    trigger = {trim(text.substr(0, sign)), text[sign] == '>', 0.0};
  }
  if (trigger.column.empty() || !parseLiteral(trim(text.substr(sign + 1)), trigger.level)) {
    throw ExperimentError(start.when->where, text,
                          "must be 'first', a date and time such as 2026-11-26T10:00:00Z, or a column and a "
                          "number, such as 'F > 0.5'");
  }
  return trigger;
}

double findStart(const Table& table, const MeasurementSpec& spec) {
  double stamp = 0.0;
  if (!spec.start.when) {
    return spec.start.time;
  }
  if (parseTimeStamp(spec.start.when->text, stamp)) {
    return stamp + spec.start.time;
  }
  const Index rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  const VectorXd times = readUnorderedTimes(table, makeTimeBase(spec, 0.0), rows);
  const Index first = findEarliest(times, [](Index) { return true; });
  if (first < 0) {
    throw MeasurementError(table.source +
                           ": no row has a time, so that measurement.start.when finds no start");
  }
  const std::optional<Trigger> trigger = findTrigger(spec.start);
  return (trigger ? findTriggered(table, *trigger, times, first) : times[first]) + spec.start.time;
}

}  // namespace twinmap
