#include "framework/data/measurement/measurement_start.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/trigger.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

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
