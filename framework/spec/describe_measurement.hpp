#pragma once

#include "framework/spec/fields/fields.hpp"
#include "framework/spec/measurement_spec.hpp"

namespace twinmap {

template <class Fields>
void describe(Fields& f, MeasurementSpec& s) {
  f.optional("time", s.time, "column of the times, such as 't [ms]' (default: t or time, in s)");
  f.optional("sample_rate", s.sample_rate, "instead of a column of times; Hz", kPositive);
  f.optional("start", s.start, "time in the table at which the model's time is 0; s");
  f.optionalMap("columns", s.columns,
                "column of each output, such as 'enc1 [mm]' (default: its own name, in its own unit)");
  f.rule(!s.time || !s.sample_rate, "must give time or sample_rate, not both");
}

}  // namespace twinmap
