#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/column_spec.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

struct ModelSpec;

/// Where the time of a measurement stands in its table.
struct TrackTimeSpec {
  std::optional<ColumnSpec> column;
};

template <class Fields>
void describe(Fields& f, TrackTimeSpec& s) {
  f.optional("column", s.column,
             "column whose first value is the measurement's time: a date and time (ISO 8601), or seconds "
             "since 1970 (default: --at, else the number of the measurement)");
}

/// A parameter that walks at random.
struct WalkSpec {
  std::optional<Name> rate;      ///< "unknown"
  std::optional<double> stddev;  ///< in the parameter's unit ...
  std::optional<Name> over;      ///< ... over this span of time
};

template <class Fields>
void describe(Fields& f, WalkSpec& s) {
  f.scalarIsValueOf("rate");
  f.optional("rate", s.rate, "unknown: it is estimated");
  f.optional("stddev", s.stddev, "how far it walks (standard deviation), in its unit, or 0; over `over`",
             kNonNegative);
  f.optional("over", s.over, "a span of time: seconds, or with a unit, as 30 d");
  f.rule(s.rate.has_value() != (s.stddev.has_value() && s.over.has_value()),
         "must be unknown, or give 'stddev' and 'over'");
}

/// How a parameter moves from one measurement to the next.
struct DriftSpec {
  Name name;
  std::optional<WalkSpec> random_walk;
  std::optional<Name> trend;  ///< "unknown"
};

template <class Fields>
void describe(Fields& f, DriftSpec& s) {
  f.optional("random_walk", s.random_walk, "unknown, or a standard deviation over a span of time");
  f.optional("trend", s.trend,
             "unknown: a constant slope beside a random walk (default of the walk: of unknown rate)");
  f.rule(s.random_walk || s.trend, "must give random_walk or trend");
}

/// Conditions that a parameter follows.
struct FollowSpec {
  Name name;
  std::vector<Name> conditions;  ///< columns
};

template <class Fields>
void describe(Fields& f, FollowSpec& s) {
  f.value(s.conditions);
}

/// How often, and by how much, a parameter changes suddenly.
struct ChangeSpec {
  Name name;
  std::optional<Name> every;
  std::optional<Name> size;
};

template <class Fields>
void describe(Fields& f, ChangeSpec& s) {
  f.optional("every", s.every,
             "mean span of time between changes, as 1 year; what changes more often is suspected first");
  f.optional("size", s.size, "standard deviation of a change, in the parameter's unit, or unknown");
}

struct AlarmSpec {
  Name false_alarms{"1 in 1000", {}};
};

template <class Fields>
void describe(Fields& f, AlarmSpec& s) {
  f.optional("false_alarms", s.false_alarms,
             "how many measurements without a change may raise an alarm, of all parameters together");
}

/// Values that a parameter must stay within.
struct LimitSpec {
  Name name;
  std::optional<double> min, max;
};

template <class Fields>
void describe(Fields& f, LimitSpec& s) {
  f.optional("min", s.min, "in the parameter's unit");
  f.optional("max", s.max, "in the parameter's unit");
  f.rule(s.min || s.max, "must give min or max");
  f.rule(!s.min || !s.max || *s.min < *s.max, "must give min below max");
}

/// How parameters move over time, for `twinmap track`. It stands beside an experiment, whose digest is
/// without it. Each parameter walks at an unknown rate without it; parameters that `drift` does
/// not name are constant.
struct TrackingSpec {
  TrackTimeSpec time;
  std::vector<DriftSpec> drift;
  std::vector<FollowSpec> follows;
  std::vector<ChangeSpec> changes;
  AlarmSpec alarm;
  std::vector<LimitSpec> limits;
};

template <class Fields>
void describe(Fields& f, TrackingSpec& s) {
  f.optional("time", s.time, "where the time of a measurement stands");
  f.optionalMap("drift", s.drift, "how parameters move; what is not named is constant");
  f.optionalMap("follows", s.follows,
                "conditions (columns of the measurement) that a parameter follows linearly, by coefficients "
                "that are learnt; each is its mean over the window");
  f.optionalMap("changes", s.changes, "what is known of sudden changes");
  f.optional("alarm", s.alarm, "when a change is announced");
  f.optionalMap("limits", s.limits, "values that parameters must stay within, whose crossing is forecast");
}

/// A span of time in s: a number of seconds, or with a unit that UDUNITS-2 knows, "30 d", "1 year". Throws
/// ExperimentError for other texts, and for what is not above 0.
double readSpan(const Name& text);

/// "1 in 1000", or a number from 1e-6 to .1: as a probability. Throws ExperimentError for others.
double readFalseAlarms(const Name& text);

/// Throws ExperimentError for names that are not parameters, words other than unknown, spans and sizes that
/// cannot be read, and limits outside the bounds.
void checkTracking(const TrackingSpec& tracking, const ModelSpec& model);

}  // namespace twinmap
