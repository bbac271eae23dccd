#pragma once

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/measurement_spec.hpp"

namespace twinmap {

/// The time in a table (s, in its own clock) at which the model's time is 0. A trigger is the first row, in
/// the order of the times, that is past its level; its time is late by up to one sample. Throws
/// MeasurementError where no row is, where the first one is already (it does not show when that began), and
/// where no row has a time. O(rows).
double findStart(const Table& table, const MeasurementSpec& spec);

}  // namespace twinmap
