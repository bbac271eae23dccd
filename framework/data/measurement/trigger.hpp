#pragma once

#include <optional>
#include <string>

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

}  // namespace twinmap
