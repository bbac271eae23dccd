#pragma once

#include <optional>
#include <string>

#include "framework/data/measurement/table.hpp"
#include "framework/experiment/measurement_spec.hpp"

namespace twinmap {

/// A column that passes a number, in the unit that its table states.
struct Trigger {
  std::string column;
  bool above = true;  ///< else below
  double level = 0.0;
};

/// "F > 0.5" or "F < 0.5": what a start is counted from, where that is a trigger. Throws ExperimentError,
/// naming the place, for a text of another form that is neither "first" nor a date and time.
std::optional<Trigger> findTrigger(const MeasurementStartSpec& start);

/// The time in a table (s, in its own clock) at which the model's time is 0. A trigger is the first row, in
/// the order of the times, that is past its level; its time is late by up to one sample. Throws
/// MeasurementError where no row is, where the first one is already (it does not show when that began), and
/// where no row has a time. O(rows).
double findStart(const Table& table, const MeasurementSpec& spec);

}  // namespace twinmap
