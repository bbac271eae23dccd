#pragma once

#include <string>

#include "framework/experiment/model/excitation_spec.hpp"

namespace twinmap {

/// Puts values in the place of those that a table lost between `begin` and `end` (s), where a step is longer
/// than one and a half median steps, and where a held value changes over one in which a sample was due.
/// They lie, at the times at which the other samples nearby keep time, on the line between the neighbours; of
/// a spline on the cubic through four, of a held signal on the way in equal steps, its mean where it changes
/// at one of these times or another; where the next one is late, its own value from when it was due on, as
/// what holds a signal keeps time. What is not known of them (TableSpec::unknown) is what the same rule errs
/// by in stretches that the table has whole, nearby where there are ten: so much is known of its spectrum. Of
/// a held signal these are stretches between equal values or between others, in the latter as a share of the
/// change; with too few, it changes once.
///
/// Sets what is said of it (TableSpec::bridged). Throws MeasurementError, naming `source`, where a gap is
/// longer than measured->max_gap or, without that, the table has fewer than ten stretches as long. `start`:
/// s, of the file's time that is 0. O(values * lost^2).
void bridgeGaps(TableSpec& table, const std::string& source, double start, double begin, double end);

}  // namespace twinmap
