#pragma once

#include <optional>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/model/bounds_spec.hpp"

namespace twinmap {

inline constexpr NumberRule kFilterOrder{1.0, 8.0, true, "must be a whole number from 1 to 8"};

/// A Butterworth low-pass filter.
struct FilterSpec {
  int order = 2;
  Expression cutoff{"", {}};
};

template <class Fields>
void describe(Fields& f, FilterSpec& s) {
  f.required("butterworth", s.order, "order of a Butterworth low-pass filter", kFilterOrder);
  f.required("cutoff", s.cutoff, "where it passes 1 / sqrt 2 of the amplitude", Unit{"Hz"});
}

/// What a sensor makes of the quantity that it measures, in this order: a lag of first order, a filter, a
/// moving average, a delay; then it clips, and rounds. All start settled at the quantity's value at t = 0,
/// which it is taken to have had before. Texts that are empty: none.
struct SensorSpec {
  Expression lag{"", {}};      ///< s; time constant
  Expression delay{"", {}};    ///< s
  Expression average{"", {}};  ///< s; the window of a moving average
  std::optional<FilterSpec> filter;
  std::optional<double> quantum;  ///< in the output's unit
  std::optional<Bounds> range;    ///< likewise

  /// Whether readings follow the quantity as it is, but for clipping and rounding.
  bool isImmediate() const {
    return lag.text.empty() && delay.text.empty() && average.text.empty() && !filter;
  }
};

template <class Fields>
void describe(Fields& f, SensorSpec& s) {
  f.optional("lag", s.lag, "time constant of a lag of first order", Unit{"s"});
  f.optional("filter", s.filter, "a low-pass filter");
  f.optional("average", s.average, "window of a moving average", Unit{"s"});
  f.optional("delay", s.delay, "from the quantity to its reading", Unit{"s"});
  f.optional("range", s.range, "[lowest, highest] reading, in the output's unit; clips before it rounds");
  f.optional("quantum", s.quantum, "step to whose nearest multiple it rounds, in the output's unit",
             kPositive);
}

}  // namespace twinmap
